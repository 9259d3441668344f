// Data: the report as it travels in the page, decoded as src/encode.rs encodes it.

import { inflated, page } from "../shared/payload.js";

/** Values of a series from its second differences; null without one. */
async function decoded(encoded, Numbers = Float32Array) {
  if (encoded === null) return null;
  const bytes = await inflated(encoded.deflated);
  if (encoded.power === null) return new Float32Array(bytes.buffer);
  const values = new Numbers(bytes.reduce((count, byte) => count + (byte < 0x80), 0));
  let [at, last, slope] = [0, 0, 0];
  for (let k = 0; k < values.length; k += 1) {
    // Products, because shifts are of 32 bits.
    let [number, factor] = [0, 1];
    for (; bytes[at] >= 0x80; at += 1, factor *= 0x80) number += (bytes[at] & 0x7f) * factor;
    number += bytes[at] * factor;
    at += 1;
    slope += number % 2 ? -(number + 1) / 2 : number / 2;
    last += slope;
    values[k] = last * 2 ** encoded.power;
  }
  return values;
}

/** Dashes of the runs' curves, beside their colours. */
const RUN_DASHES = [[], [7, 3], [2, 2.5], [9, 3, 2, 3], [12, 4]];

/** How a run's curves look. */
export const runStyle = (index) => ({ colour: `--run-${index % 4 + 1}`, dash: RUN_DASHES[index % RUN_DASHES.length] });

/** A run with typed arrays in place of text. */
async function decodedRun(run, events, index) {
  const each = (list) => Promise.all(list.map((one) => decoded(one)));
  const cues = async (one) => ({
    specific_force: await each(one.specific_force),
    angular_velocity: await each(one.angular_velocity),
  });
  const chart = async (one) => ({
    ...one,
    times: await decoded(one.times, Float64Array) ?? times,
    lines: await Promise.all(one.lines.map(async (line) => ({ ...line, values: await decoded(line.values) }))),
  });
  const times = await decoded(run.times, Float64Array);
  return {
    ...run,
    rig: page.report.rig,
    index,
    events,
    times,
    ...runStyle(index),
    desired: await cues(run.desired),
    felt: await cues(run.felt),
    position: await each(run.position),
    orientation: await each(run.orientation),
    legs: await each(run.legs),
    tilt: await each(run.tilt),
    tilt_rate: await each(run.tilt_rate),
    lean: await decoded(run.lean),
    limited: {
      tilt: await inflated(run.limited.tilt),
      soft: await inflated(run.limited.soft),
      safety: await inflated(run.limited.safety),
      actuator: await inflated(run.limited.actuator),
    },
    charts: await Promise.all(run.charts.map(chart)),
  };
}

const decodedRuns = page.report.runs.map((run, i) => decodedRun(run, page.events[i], i));
export const report = { ...page.report, runs: await Promise.all(decodedRuns) };

/** The index of the last of the ascending times that is not after `time`; 0 if all are. */
export function indexAt(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** A series' value at `time`, on the straight line between its samples; outside of them that of the nearest. */
export function valueAt(times, values, time) {
  const i = indexAt(times, time);
  if (i === times.length - 1 || time <= times[i]) return values[i];
  const fraction = (time - times[i]) / (times[i + 1] - times[i]);
  return values[i] + fraction * (values[i + 1] - values[i]);
}
