// The page: input, steps and pictures, a frame at a time.

import { inflated, page } from "../shared/payload.js";
import { fixed } from "../shared/format.js";
import { byId, element, saveAs } from "../shared/dom.js";
import { letTurn, View } from "../shared/view.js";
import { Strip } from "../shared/strip.js";
import { addLegend, animate, Lamps, machineState, resolved, setText, STRIP } from "../shared/shown.js";
import { Controls } from "../shared/controls.js";
import { Road, SCENE } from "../shared/road.js";
import { Track } from "../shared/track.js";
import { Engine } from "./engine.js";
import { Panel } from "./panel.js";

const MESSAGES = {
  ready: "Ready. Throttle: ↑, W or its button; lean: ← →",
  off_road: "Off the road. R or Restart for another try",
  fallen: "Fallen. R or Restart for another try",
  returning: "The platform goes back to neutral …",
};

const clock = (seconds) => `${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(1).padStart(4, "0")}`;

const engine = await Engine.start(await inflated(page.module), page.parameters.map(({ start }) => start));
const road = new Road(byId("road"), engine.road(), page.half_width);
const machine = new View(byId("view"), page.rig, "motorcycle");
const strips = { surge: new Strip(byId("surge")), sway: new Strip(byId("sway")) };
const track = new Track(byId("track"), []);
const controls = new Controls();
const panel = new Panel(byId("panel"), page, {
  retune: (values) => engine.retune(values),
  setFriction: (value) => {
    if (!engine.calls.set_friction(value)) return "Cannot be used.";
    road.points = engine.road();
    return "";
  },
});
let paints = {};
const now = { view: engine.view(), isPaused: false, shownLaps: 0, toast: "", toastUntil: 0, time: 0, frames: 0, cost: 0 };

const lamps = new Lamps(byId("lamps"));
addLegend(byId("legend"));
letTurn(machine, () => {});

function pause(on = !now.isPaused) {
  now.isPaused = on;
  byId("pause").setAttribute("aria-pressed", String(on));
  byId("pause").textContent = on ? "Continue (P)" : "Pause (P)";
}

function restart() {
  pause(false);
  engine.restart();
  for (const strip of Object.values(strips)) strip.clear();
}

const toggle = (id) => { byId(id).checked = !byId(id).checked; };

const save = () => saveAs("ride.csv", engine.csv(), "text/csv");

/** Adds a row for each whole lap that has none. */
function showLaps({ laps }) {
  if (laps < now.shownLaps) now.shownLaps = laps;
  for (; now.shownLaps < laps; now.shownLaps += 1) {
    const { time, is_mixed: isMixed, ratings } = engine.lap(now.shownLaps);
    const cells = [String(now.shownLaps + 1), clock(time), panel.strategy + (isMixed ? ", changed" : "")];
    const values = (ratings || []).flatMap((one) => [one.rms_error, one.shake, one.jolt, one.peak].map((value) => fixed(value, 2)));
    byId("lap-rows").append(element("tr", {}, [...cells, ...values].map((text, i) => element(i ? "td" : "th", i > 2 ? { class: "number" } : {}, [text]))));
    byId("laps").hidden = false;
    [now.toast, now.toastUntil] = [`Lap ${now.shownLaps + 1}: ${clock(time)}. Its ratings are below.`, now.time + 6];
  }
}

/** What is said of the bend ahead: of the first one always, later where the speed is too much for it. */
function announced(view) {
  if (view.stage !== "riding") return "";
  const bend = road.bendAhead(view.distance);
  now.isPastFirst = view.distance > 1 && (now.isPastFirst || now.hasBend && !bend);
  now.hasBend = Boolean(bend);
  if (!bend || now.isPastFirst && view.speed < bend.advised + 1) return "";
  return `Bend to the ${bend.side} in ${20 * Math.ceil(bend.ahead / 20)} m: ${fixed(3.6 * bend.advised, 0)} km/h`;
}

function showNumbers(view) {
  setText("speed", fixed(3.6 * view.speed, 0));
  setText("advised", view.stage === "riding" ? `advised ${fixed(3.6 * view.advised, 0)} km/h` : "");
  byId("advised").classList.toggle("over", view.speed > view.advised + 1);
  setText("lap-time", clock(view.lap_time));
  setText("lap-number", `lap ${view.laps + 1}`);
  const exchange = view.is_exchanging ? "The strategy changes: the cue fades, and comes back" : "";
  const toast = now.time < now.toastUntil ? now.toast : "";
  setText("message", now.isPaused ? "Paused" : MESSAGES[view.stage] || exchange || toast || announced(view));
  byId("save").disabled = view.time < 1;
  lamps.show(view, now.time);
}

/** The road as it is learned, and why the platform does not use it, if so. */
function showTrack() {
  const isUsed = panel.strategy === "predictive" || !byId("learns").checked;
  setText("road-use", isUsed ? "" : "The strategy predictive alone uses the preview.");
  track.draw(paints.strip);
}

function draw(view, seconds) {
  road.draw(view, byId("map").checked, paints.scene, seconds);
  // The platform moves less, and the curves least.
  if (now.frames % 2 === 0) machine.drawState(machineState(view), paints.strip.felt);
  else if (now.frames % 6 === 1) for (const strip of Object.values(strips)) strip.draw(paints.strip);
  else if (now.frames % 6 === 3) showTrack();
  showNumbers(view);
}

/** Rides and draws for so many seconds with these commands. */
function frame(seconds, commands) {
  if (!now.isPaused) {
    engine.advance(seconds, { ...commands, isHelped: byId("helped").checked });
    now.time = engine.steps / 1000;
  }
  const view = engine.view();
  if (!now.isPaused) {
    strips.surge.push(now.time, view.desired_x, view.felt_x);
    strips.sway.push(now.time, view.desired_y, view.felt_y);
    showLaps(view);
    if (view.stage === "riding") track.take({ place: [view.x, view.y], trust: view.trust, passes: view.passes });
  }
  draw(view, seconds);
  now.view = view;
  now.frames += 1;
}

const readPaints = () => { paints = { scene: resolved(SCENE), strip: resolved(STRIP) }; };
readPaints();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readPaints);
byId("map").checked = matchMedia("(prefers-reduced-motion: reduce)").matches;
byId("restart").addEventListener("click", restart);
byId("pause").addEventListener("click", () => pause());
byId("save").addEventListener("click", save);
controls.listen(document.querySelectorAll("#pedals button"), { r: restart, p: () => pause(), h: () => toggle("helped"), m: () => toggle("map"), l: () => byId("learns").click() }, { restart });
controls.offerTilt(byId("tilt"));
byId("learns").addEventListener("change", () => engine.calls.learn(byId("learns").checked));

animate((seconds) => {
  const begin = performance.now();
  frame(seconds, controls.after(seconds));
  now.cost += performance.now() - begin;
  return !now.isHeld;
});
/** For checks: what is shown, and a frame by hand. */
globalThis.simulationRide = { now, engine, controls, frame, road, machine, strips, track };
