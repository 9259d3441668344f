// The page: messages of moris-live, and pictures of them.

import { page } from "../shared/payload.js";
import { fixed, significant } from "../shared/format.js";
import { byId, element, saveAs } from "../shared/dom.js";
import { letTurn, View } from "../shared/view.js";
import { Strip } from "../shared/strip.js";
import { addLegend, animate, Lamps, machineState, resolved, setText, STRIP } from "../shared/shown.js";
import { Road, SCENE } from "../shared/road.js";
import { Track } from "../shared/track.js";
import { ask, listenToCommands, Sliders, token } from "./orders.js";
import { Driving, DRIVING_KEY } from "./driving.js";

const RECORDED = ["time", "desired_x", "desired_y", "desired_z", "wx", "wy", "wz", "roll", "pitch", "yaw", "speed"];
const HEADER = "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed";

const machine = new View(byId("view"), page.rig, page.vehicle);
const road = page.road && new Road(byId("ahead"), page.road.points.map(([x, y, yaw, advised]) => ({ x, y, yaw, advised })), page.road.half_width);
const strips = { surge: new Strip(byId("surge")), sway: new Strip(byId("sway")) };
const track = new Track(byId("track"), page.track);
const lamps = new Lamps(byId("lamps"));
const now = { client: "", number: 0, shared: false, canDrive: false, controls: false, drives: false, names: [], view: null, place: null, placed: 0, state: "", messages: 0, recorded: null };
let paints = {};

/** A refusal, for a while. */
function say(text) {
  setText("message", text);
  clearTimeout(now.forgets);
  now.forgets = setTimeout(() => setText("message", ""), 8000);
}

/** States in which the platform rests. */
const RESTING = ["off", "settled", "neutral"];
/** States in which the legs are where they park. */
const PARKED = ["off", "settled"];
/** The next sensible command in a state; in the others the platform is on its way. */
const NEXT = { off: "start", settled: "start", neutral: "engage", fault: "clear", engaged: "disengage" };

/** Commands that work from every page. */
const ALWAYS = ["stop", "park"];

async function send(what) {
  if (!now.controls && !ALWAYS.includes(what.event)) return "This page looks only: another page controls. Stop and Park work here, too.";
  return ask(now.client, what);
}

const driving = new Driving(byId("driving"), page.handling, send);
const sliders = new Sliders(byId("panel"), page, (values) => send({ set: values }));

function record() {
  const isOn = now.recorded === null;
  if (!isOn && now.recorded.length > 1) saveAs("live.csv", `${HEADER}\n${now.recorded.join("\n")}\n`, "text/csv");
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

/** Longest time that the road goes on without a message [s]. */
const LONGEST = 0.2;

/** The view with the place on the road, which goes on between messages. */
function ridden(at) {
  const { view, place } = now;
  const far = view.speed * Math.min(LONGEST, Math.max(0, at - now.placed) / 1000);
  return { ...view, ...place, x: place.x + far * Math.cos(place.yaw), y: place.y + far * Math.sin(place.yaw), distance: place.distance + far };
}

function drawRoad(at, seconds) {
  const view = ridden(at);
  road.draw(view, false, paints.scene, seconds);
  setText("speed", fixed(3.6 * view.speed, 0));
  setText("advised", `advised ${fixed(3.6 * view.advised, 0)} km/h`);
  byId("advised").classList.toggle("over", view.speed > view.advised + 1);
}

/** Part of the steps that may be late before that is a warning. */
const FEW = 1e-3;

/** What counts of steps by their lateness mean, and whether it is a warning. A step takes 1 ms. */
function latenessInWords(classes) {
  const taken = classes.filter(([, count]) => count > 0);
  if (!taken.length) return ["No step yet.", false];
  const sum = (some) => some.reduce((total, [, count]) => total + count, 0);
  const [most] = taken[taken.length - 1];
  const share = sum(taken.filter(([end]) => end > 1)) / sum(taken);
  if (share === 0) return [`On time: every step began within ${fixed(most, 2)} ms.`, false];
  const part = share < 1e-4 ? "fewer than 0.01 %" : `${significant(100 * share, 2)} %`;
  const late = `${part} of the steps began more than 1 ms late, the latest within ${fixed(most, 1)} ms.`;
  return share > FEW ? [`Late: ${late} Other programs take this computer's time.`, true] : [`Nearly always on time: ${late}`, false];
}

function showLateness(classes) {
  const [words, isLate] = latenessInWords(classes);
  setText("late-steps", words);
  byId("late-steps").classList.toggle("late", isLate);
  const most = Math.max(...classes.map(([, count]) => count), 1);
  byId("late").tBodies[0].replaceChildren(...classes.filter(([, count]) => count > 0).map(([end, count]) => {
    const share = Math.log(1 + count) / Math.log(1 + most);
    const bar = element("div", { class: "bar", style: `width: ${100 * share}%` });
    return element("tr", {}, [element("td", {}, [`${fixed(end, 2)} ms`]), element("td", {}, [String(count)]), element("td", {}, [bar])]);
  }));
}

function take({ rows, state, health, delay, late, lines, changed, holder, is_lost: isLost, is_located: isLocated, late_frames: lateFrames, road: learned, place }) {
  if (!rows) return;
  for (const row of rows) {
    const view = Object.fromEntries(now.names.map((name, i) => [name, row[i]]));
    strips.surge.push(view.time, view.desired_x, view.felt_x);
    strips.sway.push(view.time, view.desired_y, view.felt_y);
    now.recorded?.push(RECORDED.map((name) => view[name]).join(","));
    now.view = { ...view, lean: 0, parked: PARKED.includes(state) };
    lamps.show(now.view, view.time);
  }
  track.take(learned);
  Object.assign(now, { place, placed: performance.now() });
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
  if (now.messages % 12 === 1) {
    byId("journal").replaceChildren(...lines.map((line) => element("li", {}, [line])));
    showLateness(late);
    const [last, latest] = lateFrames.map((late) => fixed(late / 1000, 1));
    setText("late-frames", `The last frame left ${last} ms after its step, the latest of all ${latest} ms.`);
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
    setText("health", "");
    now.controls = now.drives = false;
  });
  events.addEventListener("error", () => {
    setText("state", events.readyState === EventSource.CLOSED ? "ended" : "connecting …");
    setText("health", "");
  });
}

const readPaints = () => { paints = { ...resolved(STRIP), scene: resolved(SCENE) }; };
readPaints();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readPaints);
addLegend(byId("legend"));
byId("scene").hidden = !road;
letTurn(machine, () => {});
for (const button of document.querySelectorAll("#place button")) button.addEventListener("click", async () => say(await send({ legs: button.dataset.legs }) || `At the next start: ${button.textContent}.`));
byId("record").addEventListener("click", record);
listenToCommands(document.querySelectorAll("#commands button"), async (event) => say(await send({ event })), { r: record, [DRIVING_KEY]: () => driving.beginAgain() });
connect();

animate((seconds, at) => {
  if (!now.view) return true;
  if (road && now.place) drawRoad(at, seconds);
  machine.drawState(machineState(now.view), paints.felt);
  for (const strip of Object.values(strips)) strip.draw(paints);
  track.draw(paints);
  return true;
});
/** For checks: what is shown. */
globalThis.simulationLive = { now, strips, sliders, driving, track, machine, latenessInWords };
