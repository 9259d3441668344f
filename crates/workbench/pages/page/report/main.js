// The page: one time, one selected run, one window of times shown; everything drawn follows them.

import { page } from "../shared/payload.js";
import { fixed } from "../shared/format.js";
import { byId, element } from "../shared/dom.js";
import { colour } from "../shared/palette.js";
import { letTurn, View } from "../shared/view.js";
import { report } from "./data.js";
import { Chart } from "./chart.js";
import { stateAt } from "./state.js";
import { Chips, TimeLine } from "./limits.js";
import { Gauges } from "./gauges.js";
import { cellText, definitions, printBox, showMeasures } from "./measures.js";
import { overlayChoice } from "./overlay.js";
import { roughestSecond } from "./roughest.js";
import { sections } from "./panels.js";
import { Simulator } from "./simulator.js";
import { Tuning } from "./tuning.js";

const SPEEDS = ["0.1", "0.25", "0.5", "1", "2", "5"];

const recording = {
  from: Math.min(...report.runs.map((run) => run.times[0])),
  to: Math.max(...report.runs.map((run) => run.times[run.times.length - 1])),
};
const now = { time: recording.from, run: report.runs[report.selected], shown: [recording.from, recording.to], playing: false, speed: 1 };

const view = new View(byId("view"), report.rig, report.vehicle);
const gauges = new Gauges(byId("gauges"));
const chips = new Chips(byId("chips"));
const shown = () => now.shown;
const handlers = { seek, show, hover };
const timeLine = new TimeLine(shown, handlers);
let charts = [];
let tuning = null;

/** Goes to a time. */
function seek(time) {
  now.time = Math.min(recording.to, Math.max(recording.from, time));
  byId("slider").value = now.time;
  byId("now").textContent = `${fixed(now.time, 2)} s of ${fixed(recording.to, 2)} s`;
  for (const chart of [timeLine, ...charts]) chart.moveCursor(now.time);
  drawMachine();
}

/** Reads the curves at a time; null: at the cursor's. */
function hover(time) {
  for (const chart of [timeLine, ...charts]) chart.read(time, now.time);
}

/** Shows other times in the charts, within the recording; null: all of it. */
function show(times) {
  const [whole, shortest] = [recording.to - recording.from, 1e-3 * (recording.to - recording.from)];
  const span = times ? Math.min(whole, times[1] - times[0]) : whole;
  if (times && span < whole && span > shortest) {
    const from = Math.min(recording.to - span, Math.max(recording.from, times[0]));
    now.shown = [from, from + span];
  } else if (!times || span >= whole) {
    now.shown = [recording.from, recording.to];
  }
  byId("whole").hidden = now.shown[1] - now.shown[0] >= whole;
  drawCharts();
  seek(now.time);
}

/** Shows the roughest second of the shown run, and goes to its middle. */
function showRoughest() {
  const from = roughestSecond(now.run);
  show([from, from + 1]);
  seek(from + 0.5);
  document.querySelector("#charts .chart")?.scrollIntoView({ block: "center" });
}

function play(on) {
  if (on && now.time >= recording.to) seek(recording.from);
  now.playing = on;
  byId("play").textContent = on ? "Pause" : "Play";
  // On a narrow screen the machine then stands above the charts.
  document.body.classList.toggle("playing", on);
  drawMachine();
  if (!on) return;
  let before = performance.now();
  const tick = (at) => {
    if (!now.playing) return;
    const time = now.time + now.speed * Math.max(0, at - before) / 1000;
    before = at;
    seek(time);
    if (time >= recording.to) play(false);
    else requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

/** Shows a run; while a slider moves, what is out of sight waits until it rests. */
function select(index, isMoving = false) {
  const run = report.runs[index];
  const isDrawn = isMoving && run.felt === now.run.felt;
  if (tuning) tuning.see(run);
  timeLine.select(run);
  if (!isMoving) timeLine.showList();
  showFindings(run);
  if (isDrawn) {
    now.run = run;
    timeLine.draw();
    restLater();
  } else {
    showCurves(run, isMoving);
  }
  seek(now.time);
}

/** Shows the curves of a run, which may still be simulated; not the machine, which takes as long as all of them. */
function showCurves(run, isMoving = true) {
  now.run = run;
  showRunChoice();
  showKey();
  buildCharts();
  drawCharts(isMoving);
  for (const chart of charts) chart.moveCursor(now.time);
}

/** A button for each run, where there are several. */
function showRunChoice() {
  const box = byId("runs");
  const names = report.runs.map(({ name }) => name);
  if (names.length > 1 && names.join("\n") !== [...box.children].map(({ textContent }) => textContent).join("\n")) {
    box.replaceChildren(...report.runs.map((run, i) => {
      const button = element("button", { type: "button", style: `--run: var(${run.colour})` }, [run.name]);
      button.addEventListener("click", () => select(i));
      return button;
    }));
  }
  [...box.children].forEach((button, i) => button.setAttribute("aria-pressed", String(i === now.run.index)));
}

/** What the elements of charts depend on, as one text; their curves and limits change within them. */
const shapeOf = (built) => JSON.stringify([now.run.name, report.runs.length > 1, built], (key, value) => {
  if (key === "limits") return value.length;
  return ["times", "values", "others"].includes(key) ? undefined : value;
});

/** Makes the charts of the shown run, or puts its curves into those that there are. */
function buildCharts() {
  const wanted = sections(now.run);
  const shape = shapeOf(wanted);
  if (shape === buildCharts.shape) {
    wanted.flatMap(({ charts: listed }) => listed).forEach((one, i) => charts[i].take(one));
    return;
  }
  buildCharts.shape = shape;
  const box = byId("charts");
  const of = report.runs.length > 1 ? ` (${now.run.name})` : "";
  const lane = element("section", {}, [element("h2", {}, ["Active limits" + of]), timeLine.element]);
  charts = [];
  const built = wanted.map(({ heading, charts: listed, note, of_run: ofRun }) => {
    const made = listed.map((one) => new Chart(one, shown, handlers));
    charts.push(...made);
    const parts = made.map((chart) => chart.element);
    if (note) parts.push(element("p", { class: "summary" }, [note]));
    return element("section", {}, [element("h2", {}, [heading + (ofRun ? of : "")]), ...parts]);
  });
  const choice = overlayChoice(now.run, () => {
    buildCharts();
    drawCharts();
    seek(now.time);
  });
  choice.open = byId("overlay")?.open ?? false;
  box.replaceChildren(lane, ...built, choice);
}

/** Time without a change after which the rest is drawn [ms]. */
const REST = 250;

function isInSight(part) {
  const { top, bottom } = part.getBoundingClientRect();
  return bottom > 0 && top < innerHeight;
}

/** Draws all charts; while a slider moves, first those in sight. */
function drawCharts(isMoving = false) {
  clearTimeout(drawCharts.timer);
  const all = [timeLine, ...charts];
  // All are measured before any is drawn, so that the page is laid out once.
  const due = isMoving ? all.filter(({ plot }) => isInSight(plot.box)) : all;
  for (const chart of due) chart.draw();
  if (isMoving) restLater();
}

/** Draws what waits, unless something moves before. */
function restLater() {
  clearTimeout(drawCharts.timer);
  drawCharts.timer = setTimeout(showRest, REST);
}

/** What waits while a slider moves; measures also wait for the end of the run whose first curves are shown. */
function showRest() {
  timeLine.showList();
  if (!tuning?.isPart) showAllMeasures();
  drawCharts();
}

const showAllMeasures = () => showMeasures(byId("measures"), report.runs);

function drawMachine() {
  view.rig = now.run.rig;
  const state = stateAt(now.run, now.time);
  view.drawState(state, colour(now.run.colour));
  gauges.update(state, now.run.rig);
  chips.update(state);
}

function showFindings(run) {
  const marks = { good: "\u2713", note: "\u2022", warning: "!" };
  const { weight, text } = run.verdict;
  Object.assign(byId("headline"), { hidden: !text, className: weight, textContent: text });
  byId("findings").replaceChildren(...[...run.findings, ...report.findings].map(({ weight, text }) => {
    const mark = element("span", { class: "finding-mark", "aria-hidden": "true" }, [marks[weight]]);
    return element("li", { class: weight }, [mark, element("span", {}, [text])]);
  }));
}

function showKey() {
  const arrow = (name, text) => [element("span", { class: "swatch", style: `border-top: 4px solid var(${name})` }), text];
  byId("key").replaceChildren(
    ...arrow("--desired", "desired "), ...arrow(now.run.colour, "felt "),
    "\u2014 arrows at the head: specific force less gravity at rest. Legs: ",
    ...arrow("--leg-easy", "free "), ...arrow("--leg-near", "near "), ...arrow("--leg-end", "at an end of the stroke"),
  );
}

/** Shows a multiple of the times shown, around the cursor. */
function zoom(factor) {
  const [from, to] = now.shown;
  const middle = Math.min(to, Math.max(from, now.time));
  show([middle - (middle - from) * factor, middle + (to - middle) * factor]);
}

function setUpPlayer() {
  const slider = byId("slider");
  Object.assign(slider, { min: recording.from, max: recording.to });
  slider.addEventListener("input", () => seek(Number(slider.value)));
  byId("play").addEventListener("click", () => play(!now.playing));
  byId("whole").addEventListener("click", () => show(null));
  byId("roughest").addEventListener("click", showRoughest);
  const speed = byId("speed");
  speed.append(...SPEEDS.map((factor) => element("option", { value: factor }, [`\u00d7 ${factor}`])));
  speed.value = "1";
  speed.addEventListener("change", () => { now.speed = Number(speed.value); });
  addEventListener("keydown", (event) => {
    if (event.target !== document.body) return;
    const step = (recording.to - recording.from) / 200;
    if (event.key === " ") play(!now.playing);
    else if (event.key === "ArrowLeft") seek(now.time - step);
    else if (event.key === "ArrowRight") seek(now.time + step);
    else if (event.key === "+" || event.key === "=") zoom(0.5);
    else if (event.key === "-") zoom(2);
    else if (event.key === "r" && !event.ctrlKey && !event.metaKey) showRoughest();
    else return;
    event.preventDefault();
  });
}

/** Shows one of the runs that there are now. */
function showRun(run, isMoving = false) {
  if (!isMoving || isInSight(byId("measures"))) showAllMeasures();
  select(run.index, isMoving);
}

/** In place of the panel of parameters. */
function explainMissingTuning(reason) {
  byId("tuning").replaceChildren(element("summary", {}, ["Change parameters"]), element("p", { class: "summary" }, [reason]));
  byId("tuning").hidden = false;
}

/** The panel of parameters, if this page can simulate. */
async function setUpTuning() {
  if (!report.simulator) {
    if (report.no_simulator_because) explainMissingTuning(report.no_simulator_because);
    return;
  }
  const simulator = new Simulator(report.simulator, page.worker);
  await simulator.prepare();
  tuning = new Tuning(byId("tuning"), simulator, showRun, showCurves);
  tuning.see(now.run);
}

function redraw() {
  drawCharts();
  seek(now.time);
}

showAllMeasures();
byId("provenance").append(...report.provenance.map(([name, text]) => element("span", {}, [element("b", {}, [name]), " ", text])));
setUpPlayer();
letTurn(view, drawMachine);
select(report.selected);
addEventListener("resize", redraw);
// The panel takes height from the picture, which keeps its proportions.
new ResizeObserver(drawMachine).observe(byId("view"));
// A print is as wide as its paper and in light colours. The definitions are in it if the reader wants them.
const folded = [];
addEventListener("beforeprint", () => {
  document.documentElement.classList.add("printing");
  const definitions = document.querySelector("#measures details");
  if (definitions && !definitions.open && printBox.checked) {
    definitions.open = true;
    folded.push(definitions);
  }
  redraw();
});
addEventListener("afterprint", () => {
  document.documentElement.classList.remove("printing");
  for (const part of folded.splice(0)) part.open = false;
  redraw();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

// For those who drive the page from a script, such as its tests.
window.simulationReport = { now, seek, show, play, select, view, recording, ranges: () => charts.map((chart) => chart.range()),
  runs: () => report.runs, cellText };
byId("alarm").hidden = true;
await setUpTuning().catch((error) => explainMissingTuning(`This browser cannot simulate: ${error.message}`));
if (tuning) window.simulationReport.tuning = tuning;
