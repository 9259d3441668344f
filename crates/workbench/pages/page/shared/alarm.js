// Runs before everything else: a page whose script fails says so, instead of standing there half empty.
const alarmBox = document.getElementById("alarm");

function raiseAlarm(what) {
  alarmBox.textContent = "This page could not be drawn completely: " + what
    + ". The file still holds all data; a newer browser may show them.";
  alarmBox.hidden = false;
  document.body.classList.add("failed");
}

addEventListener("error", (event) => raiseAlarm(event.message + " (line " + event.lineno + ")"));
addEventListener("unhandledrejection", (event) => raiseAlarm(String(event.reason)));
