// The simulation of the recording: a worker, and a run of its answers.

import { inflated } from "../shared/payload.js";

/** Values from the bytes of all first places, all second places, and so on, as src/encode.rs writes them. */
async function exactValues(text) {
  const planes = await inflated(text);
  const count = planes.length / 8;
  const bytes = new Uint8Array(planes.length);
  for (let place = 0; place < 8; place += 1) {
    for (let k = 0; k < count; k += 1) bytes[8 * k + place] = planes[place * count + k];
  }
  return new Float64Array(bytes.buffer);
}

export class Simulator {
  /** `data`: as src/simulator.rs describes it; `script`: the worker's. */
  constructor(data, script) {
    this.data = data;
    this.worker = new Worker(URL.createObjectURL(new Blob([script], { type: "text/javascript" })));
  }

  /** The worker's answer; `take(part)` gets the parts of curves that come before it. */
  ask(message, transfer = [], take = null) {
    return new Promise((resolve, reject) => {
      this.worker.onmessage = ({ data }) => {
        if (data.part) take(data.part);
        else if (data.failure) reject(new Error(data.failure));
        else resolve(data);
      };
      this.worker.onerror = (event) => {
        event.preventDefault();
        reject(new Error(event.message || "the browser allows no worker"));
      };
      this.worker.postMessage(message, transfer);
    });
  }

  /** Gives the worker the module and the recording. */
  async prepare() {
    const { data } = this;
    const [module, ...inputs] = await Promise.all([inflated(data.module), ...data.inputs.map(exactValues)]);
    const count = inputs[0].length;
    // The bounds are those of the whole recording.
    const bounds = data.bounds.map((bound) => (count === data.samples ? bound : null) ?? NaN);
    const head = [data.step, ...bounds, ...data.parameters.map(({ start }) => start)];
    const recorded = new Float64Array(head.length + count * inputs.length);
    recorded.set(head);
    inputs.forEach((series, slot) => {
      for (let k = 0; k < count; k += 1) recorded[head.length + k * inputs.length + slot] = series[k];
    });
    ({ samples: this.samples } = await this.ask({ module, recorded }, [module.buffer, recorded.buffer]));
    this.times = Float64Array.from({ length: this.samples }, (_, k) => k * data.step);
  }

  /** The verdict on the rig of these parameters; or `reason`, why there is none. */
  check(values) {
    return this.ask({ rig: Float64Array.of(this.data.actuator_diameter ?? NaN, ...values) });
  }

  /**
   * A run with these parameters as the page's others are; or `reason`, why there is none; or `isAbandoned`.
   *
   * `show(run)` gets the run while it is simulated: with new curves up to a time, and those of `before` after it. If `before`
   * has other times, that is when all curves are new.
   */
  async run(values, before, show) {
    const fits = before.times.length === this.samples;
    let run = null;
    const take = ({ from, to, curves, ...head }) => {
      run ??= this.begun(head, before, fits);
      seriesOf(run).forEach((series, i) => series.set(curves.subarray(i * (to - from), (i + 1) * (to - from)), from));
      if (fits || to === this.samples) show(run);
    };
    const { tilt, ...answer } = await this.ask({ values: Float64Array.from(values) }, [], take);
    return answer.measures ? { ...run, ...answer, limited: { ...run.limited, tilt } } : answer;
  }

  /** Gives a run up, after the part that is under way. */
  abandon() {
    this.worker.postMessage({ abandon: true });
  }

  /** A run without curves of its own: with those of another, where that has the same times. */
  begun({ limits, rig, charts }, before, fits) {
    const like = (series, Numbers = Float32Array) => new Numbers(fits && series ? series : this.samples);
    const each = (list) => list.map((series) => like(series));
    const cues = ({ specific_force: force, angular_velocity: rate }) => ({ specific_force: each(force), angular_velocity: each(rate) });
    const flags = (series) => like(series, Uint8Array);
    const { tilt, soft, safety, actuator } = before.limited;
    const chart = ({ title, quantity, label }) => {
      const known = before.charts.find((one) => one.title === title)?.lines.find((line) => line.label === label);
      return { title, quantity, times: this.times, lines: [{ label, values: like(known?.values) }], limits: [] };
    };
    return {
      limits, rig, charts: charts.map(chart), times: this.times, verdict: { weight: "note", text: "" }, findings: [], measures: [], events: [],
      desired: cues(before.desired), felt: cues(before.felt), position: each(before.position), orientation: each(before.orientation),
      legs: each(before.legs), tilt: each(before.tilt), tilt_rate: each(before.tilt_rate), lean: like(before.lean),
      limited: { tilt: flags(tilt), soft: flags(soft), safety: flags(safety), actuator: flags(actuator) },
    };
  }
}

/** The curves of a run in the order in which the module has them; the flag of the tilt comes with the measures. */
const seriesOf = ({ desired, felt, position, orientation, legs, tilt, tilt_rate: rate, lean, limited, charts }) => [
  ...[desired, felt].flatMap((cues) => [...cues.specific_force, ...cues.angular_velocity]), ...position, ...orientation, ...legs,
  ...tilt, ...rate, lean, limited.soft, limited.safety, limited.actuator, ...charts.map(({ lines }) => lines[0].values),
];
