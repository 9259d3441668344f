// Data: the report as it travels in the page, decoded.

const page = JSON.parse(document.getElementById("data").textContent);

function bytes(text) {
  const letters = atob(text);
  const decoded = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i += 1) decoded[i] = letters.charCodeAt(i);
  return decoded;
}

const numbers32 = (text) => new Float32Array(bytes(text).buffer);
const numbers64 = (text) => new Float64Array(bytes(text).buffer);

/** Dashes of the runs' curves, beside their colours. */
const RUN_DASHES = [[], [7, 3], [2, 2.5], [9, 3, 2, 3], [12, 4]];

/** A run with typed arrays in place of base64. */
function decodedRun(run, events, index) {
  const each = (list) => list.map(numbers32);
  const cues = (one) => ({
    specific_force: each(one.specific_force),
    angular_velocity: each(one.angular_velocity),
  });
  const times = numbers64(run.times);
  return {
    ...run,
    index,
    events,
    times,
    colour: `--run-${index % 4 + 1}`,
    dash: RUN_DASHES[index % RUN_DASHES.length],
    desired: cues(run.desired),
    felt: cues(run.felt),
    position: each(run.position),
    orientation: each(run.orientation),
    legs: each(run.legs),
    tilt: each(run.tilt),
    tilt_rate: each(run.tilt_rate),
    lean: run.lean === "" ? null : numbers32(run.lean),
    limited: {
      tilt: bytes(run.limited.tilt),
      safety: bytes(run.limited.safety),
      actuator: bytes(run.limited.actuator),
    },
    charts: run.charts.map((chart) => ({
      ...chart,
      times: chart.times === "" ? times : numbers64(chart.times),
      lines: chart.lines.map((line) => ({ ...line, values: numbers32(line.values) })),
    })),
  };
}

const report = { ...page.report, runs: page.report.runs.map((run, i) => decodedRun(run, page.events[i], i)) };

/** The index of the last of the ascending times that is not after `time`; 0 if all are. */
function indexAt(times, time) {
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
function valueAt(times, values, time) {
  const i = indexAt(times, time);
  if (i === times.length - 1 || time <= times[i]) return values[i];
  const share = (time - times[i]) / (times[i + 1] - times[i]);
  return values[i] + share * (values[i + 1] - values[i]);
}
