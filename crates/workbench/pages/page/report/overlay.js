// Channels chosen by the reader, in one chart.

import { element } from "../shared/dom.js";
import { DASHES } from "../shared/palette.js";
import { actuatorsOf, AXES, inDegrees, LEGS, TURNS } from "./axes.js";

const overlay = new Set();

/** Every channel of a run: name, unit, values. */
function channelsOf(run) {
  const actuators = actuatorsOf(run.rig);
  const cues = [["desired", run.desired], ["felt", run.felt]].flatMap(([what, cue]) => [
    ...AXES.map(([name], i) => [`${name}, ${what}`, "m/s\u00b2", cue.specific_force[i]]),
    ...TURNS.map((name, i) => [`${name} rate, ${what}`, "\u00b0/s", inDegrees(cue.angular_velocity[i])]),
  ]);
  return [
    ...cues,
    ...run.position.map((values, i) => [`Position ${AXES[i][1]}`, "m", values]),
    ...run.orientation.map((values, i) => [TURNS[i], "\u00b0", inDegrees(values)]),
    ...run.tilt.map((values, i) => [`Tilt, ${TURNS[i].toLowerCase()}`, "\u00b0", inDegrees(values)]),
    ...run.legs.map((values, i) => [`${actuators.name} ${i + 1}`, actuators.unit, actuators.shown(values)]),
  ].map(([name, unit, values]) => ({ name, unit, values }));
}

/** The section with the channels that the reader has chosen. */
export function overlaid(run) {
  if (overlay.size === 0) return [];
  const chosen = channelsOf(run).filter(({ name }) => overlay.has(name));
  const lines = chosen.map(({ name, unit, values }, i) => ({
    label: `${name} [${unit}]`, colour: LEGS[i % 6], dash: DASHES[i % DASHES.length], width: 1.6, times: run.times, values,
  }));
  return [{ heading: "Chosen channels", of_run: true, charts: [{ title: "Overlay", unit: "each in its own unit", lines, height: 220, digits: 3 }] }];
}

/** The list to choose from. */
export function overlayChoice(run, changed) {
  const boxes = channelsOf(run).map(({ name }) => {
    const box = element("input", { type: "checkbox" });
    box.checked = overlay.has(name);
    box.addEventListener("change", () => {
      if (box.checked) overlay.add(name);
      else overlay.delete(name);
      changed();
    });
    return element("label", {}, [box, " ", name]);
  });
  return element("details", { id: "overlay" }, [element("summary", {}, ["Overlay channels in one chart"]), element("div", { class: "choices" }, boxes)]);
}
