// The page: messages of moris live, and pictures of them.

const RECORDED = ["time", "desired_x", "desired_y", "desired_z", "wx", "wy", "wz", "roll", "pitch", "yaw", "speed"];
const HEADER = "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed";

const machine = new View(byId("view"), page.rig, "motorcycle");
const strips = { surge: new Strip(byId("surge")), sway: new Strip(byId("sway")) };
const track = new Track(byId("road"), page.track);
const lamps = new Lamps(byId("lamps"));
const now = { client: "", number: 0, shared: false, canDrive: false, controls: false, drives: false, names: [], view: null, state: "", messages: 0, recorded: null };
let paints = {};

/** A refusal, for a while. */
function say(text) {
  setText("message", text);
  clearTimeout(now.forgets);
  now.forgets = setTimeout(() => setText("message", ""), 8000);
}

/** States in which the platform rests. */
const RESTING = ["off", "settled", "neutral"];
/** The next sensible command in a state; in the others the platform is on its way. */
const NEXT = { off: "start", settled: "start", neutral: "engage", fault: "clear", engaged: "disengage" };

/** Commands that work from every page. */
const ALWAYS = ["stop", "park"];

async function send(what) {
  if (!now.controls && !ALWAYS.includes(what.event)) return "This page looks only: another page controls. Stop and Park work here, too.";
  return ask(now.client, what);
}

const driving = new Driving(byId("driving"), page.handling, send);
const pair = new Pair(document.querySelectorAll("#pair button"), send);
const sliders = new Sliders(byId("panel"), page, (values) => send({ set: values }));

function record() {
  const isOn = now.recorded === null;
  if (!isOn && now.recorded.length > 1) {
    const link = element("a", { download: "live.csv" });
    link.href = URL.createObjectURL(new Blob([`${HEADER}\n${now.recorded.join("\n")}\n`], { type: "text/csv" }));
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  now.recorded = isOn ? [] : null;
  byId("record").setAttribute("aria-pressed", String(isOn));
  byId("record").textContent = isOn ? "Stop and save (R)" : "Record (R)";
}

/** `holder` is the number of the page that controls, or 0: then the next that asks does. */
function showRole(holder) {
  now.controls = now.shared || holder === 0 || holder === now.number;
  now.drives = now.canDrive && (holder === 0 || holder === now.number);
  driving.run(() => now.drives);
  setText("role", now.controls ? (holder === 0 ? "No page controls: the next command does." : "This page controls.") : "This page looks only: another one controls. Stop and Park work here, too.");
  for (const button of document.querySelectorAll("#commands button")) button.disabled = !now.controls && !ALWAYS.includes(button.dataset.event);
}

function showLateness(classes) {
  const most = Math.max(...classes.map(([, count]) => count), 1);
  byId("late").tBodies[0].replaceChildren(...classes.filter(([, count]) => count > 0).map(([end, count]) => {
    const share = Math.log(1 + count) / Math.log(1 + most);
    const bar = element("div", { class: "bar", style: `width: ${100 * share}%` });
    return element("tr", {}, [element("td", {}, [`${fixed(end, 2)} ms`]), element("td", {}, [String(count)]), element("td", {}, [bar])]);
  }));
}

function take({ rows, state, health, delay, late, lines, changed, pair: told, holder, is_lost: isLost, is_located: isLocated, late_frames: lateFrames, road }) {
  if (!rows) return;
  for (const row of rows) {
    const view = Object.fromEntries(now.names.map((name, i) => [name, row[i]]));
    strips.surge.push(view.time, view.desired_x, view.felt_x);
    strips.sway.push(view.time, view.desired_y, view.felt_y);
    now.recorded?.push(RECORDED.map((name) => view[name]).join(","));
    now.view = { ...view, lean: 0 };
    lamps.show(now.view, view.time);
  }
  track.take(road);
  now.messages += 1;
  now.state = state;
  setText("state", state);
  byId("state").classList.toggle("fault", state === "fault");
  byId("state").classList.toggle("moving", !RESTING.includes(state));
  for (const button of document.querySelectorAll("#commands button")) button.classList.toggle("next", NEXT[state] === button.dataset.event);
  byId("lost").hidden = !isLost;
  byId("place").hidden = isLocated;
  showRole(holder);
  setText("health", `telemetry: ${health}, delay ${fixed(1000 * delay, 0)} ms`);
  sliders.take(changed);
  pair.take(told, now.controls);
  if (now.messages % 12 === 1) {
    byId("journal").replaceChildren(...lines.map((line) => element("li", {}, [line])));
    showLateness(late);
    setText("late-frames", `Frames leave ${lateFrames.map((late) => fixed(late / 1000, 1)).join(" ms late, at most ")} ms.`);
  }
}

function connect() {
  const events = new EventSource(`/events?token=${token}`);
  events.addEventListener("welcome", ({ data }) => {
    const { client, number, shared, can_drive: canDrive, controls, names } = JSON.parse(data);
    Object.assign(now, { client, number, shared, canDrive, names });
    for (const strip of Object.values(strips)) strip.clear();
    showRole(controls ? number : -1);
  });
  events.addEventListener("message", ({ data }) => take(JSON.parse(data)));
  events.addEventListener("end", () => {
    events.close();
    setText("state", "ended");
    now.controls = now.drives = false;
  });
  events.addEventListener("error", () => {
    setText("state", events.readyState === EventSource.CLOSED ? "ended" : "connecting …");
    setText("health", "");
  });
}

const readPaints = () => { paints = resolved(STRIP); };
readPaints();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readPaints);
addLegend(byId("legend"));
letTurn(machine, () => {});
for (const button of document.querySelectorAll("#place button")) button.addEventListener("click", async () => say(await send({ legs: button.dataset.legs }) || `At the next start: ${button.textContent}.`));
byId("record").addEventListener("click", record);
listenToCommands(document.querySelectorAll("#commands button"), async (event) => say(await send({ event })), { r: record, ...pair.keys, [DRIVING_KEY]: () => driving.beginAgain() });
connect();

function tick() {
  if (now.view) {
    machine.drawState(machineState(now.view), paints.felt);
    for (const strip of Object.values(strips)) strip.draw(paints);
    track.draw(paints);
  }
  requestAnimationFrame(tick);
}
requestAnimationFrame(tick);
document.getElementById("alarm").hidden = true;
/** For checks: what is shown. */
globalThis.simulationLive = { now, strips, sliders, driving, track };
