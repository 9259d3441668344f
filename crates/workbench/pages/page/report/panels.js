// Which charts there are.

import { DEGREES } from "../shared/format.js";
import { colour, DASHES } from "../shared/palette.js";
import { report } from "./data.js";
import { extent } from "./thin.js";
import { actuatorsOf, AXES, inDegrees, LEGS, THREE, TURNS } from "./axes.js";
import { overlaid } from "./overlay.js";

/** Cues that vary less than this are not worth a chart: m/s2, degrees/s. */
const STILL = { specific_force: 0.01, angular_velocity: 0.05 };

/** Felt against desired on one axis, felt for every run, on one vertical axis whichever is selected. */
function cueLines(quantity, axis, selected, convert) {
  const desired = {
    label: "desired", colour: "--desired", width: 4,
    times: selected.times, values: convert(selected.desired[quantity][axis]),
  };
  const felt = report.runs.map((run) => ({
    label: report.runs.length > 1 ? `felt, ${run.name}` : "felt", colour: run.colour, dash: run.dash, width: run === selected ? 1.8 : 1,
    times: run.times, values: convert(run.felt[quantity][axis]), aside: run !== selected,
    layer: run === selected ? 2 : 1,
  }));
  return [desired, ...felt];
}

/** Charts of all axes of a cue on which something happens, and a line of text about the others. */
function cuePanels(quantity, names, unitText, convert, selected, options) {
  const charts = [];
  const still = [];
  names.forEach((title, axis) => {
    const lines = cueLines(quantity, axis, selected, convert);
    const varies = lines.some(({ times: at, values, aside }) => {
      if (aside) return false;
      const [low, high] = extent(at, values, at[0], at[at.length - 1]) || [0, 0];
      return high - low > STILL[quantity];
    });
    if (varies) charts.push({ title, unit: unitText, lines, ...options });
    else still.push(title.toLowerCase());
  });
  const note = still.length > 0 ? `Not drawn, because it varies by less than ${STILL[quantity]} ${unitText}: ${still.join("; ")}.` : null;
  return { charts, note };
}

/** Curves of the selected run; the curves of the other runs set the vertical axis with them. */
function series(selected, list, names, colours, convert = (values) => values) {
  const of = (run) => list(run).map((values, i) => ({
    label: names[i], colour: colours[i], dash: DASHES[i], width: 1.6, times: run.times, values: convert(values),
  }));
  return { lines: of(selected), others: report.runs.filter((run) => run !== selected).flatMap(of) };
}

const bothWays = (limit) => (limit > 0 ? [-limit, limit] : []);

/** The sections of the page for a run: heading, charts, and a note where something is left out. */
export function sections(run) {
  const position = ({ position: [x, y, z], rig }) => [x, y, z.map((value) => value - rig.neutral_height)];
  const actuators = actuatorsOf(run.rig);
  const forces = AXES.map(([name, axis]) => `${name}, ${axis}`);
  const rates = TURNS.map((name, i) => `${name} rate, ${AXES[i][1]}`);
  return [
    { heading: "Specific force at the rider's head", ...cuePanels("specific_force", forces, "m/s\u00b2", (values) => values, run, { least: 0.2 }) },
    { heading: "Angular velocity of the rider's head", ...cuePanels("angular_velocity", rates, "\u00b0/s", inDegrees, run, { least: 1 }) },
    { heading: "Platform", of_run: true, charts: [
      { title: "Position from neutral", unit: "m", ...series(run, position, ["x", "y", "z"], THREE), least: 0.05, digits: 3 },
      { title: "Orientation", unit: "\u00b0", ...series(run, ({ orientation }) => orientation, ["roll", "pitch", "yaw"], THREE, inDegrees), least: 1 },
    ] },
    { heading: "Tilt coordination", of_run: true, charts: [
      { title: "Tilt", unit: "\u00b0", ...series(run, ({ tilt }) => tilt, ["roll", "pitch"], THREE, inDegrees), least: 1 },
      { title: "Tilt rate", unit: "\u00b0/s", ...series(run, ({ tilt_rate: rate }) => rate, ["roll", "pitch"], THREE, inDegrees), limits: bothWays(run.limits.tilt_rate * DEGREES), least: 1 },
    ] },
    { heading: actuators.heading, of_run: true, charts: [
      { title: actuators.title, unit: actuators.unit, ...series(run, ({ legs }) => legs, ["1", "2", "3", "4", "5", "6"], LEGS, actuators.shown), limits: actuators.shown(run.rig.stroke), height: 190, digits: actuators.digits },
    ] },
    ...furtherSections(),
    ...overlaid(run),
  ].filter(({ charts, note }) => charts.length > 0 || note);
}

/** Charts that the runs bring themselves; those of the same title share one. */
function furtherSections() {
  const charts = new Map();
  for (const run of report.runs) {
    for (const chart of run.charts) {
      if (!charts.has(chart.title)) charts.set(chart.title, { title: chart.title, unit: chart.quantity, lines: [], limits: chart.limits });
      // What is desired is the recording's, the same for every run.
      const isNew = (line) => line.label !== "desired" || charts.get(chart.title).lines.every(({ label }) => label !== "desired");
      const lines = chart.lines.filter(isNew).map((line, i) => ({
        label: report.runs.length > 1 && line.label !== "desired" ? `${line.label}, ${run.name}` : line.label,
        colour: line.label === "desired" ? "--desired" : report.runs.length > 1 ? run.colour : LEGS[i % 6],
        dash: DASHES[i % DASHES.length],
        width: 1.6, times: chart.times, values: line.values,
      }));
      charts.get(chart.title).lines.push(...lines);
    }
  }
  return charts.size > 0 ? [{ heading: "Further", charts: [...charts.values()] }] : [];
}
