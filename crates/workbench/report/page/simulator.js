// The simulation of the recording: a worker, and a run of its answers.

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

class Simulator {
  /** `data`: as src/simulator.rs describes it; `script`: the worker's. */
  constructor(data, script) {
    this.data = data;
    this.worker = new Worker(URL.createObjectURL(new Blob([script], { type: "text/javascript" })));
  }

  ask(message, transfer = []) {
    return new Promise((resolve, reject) => {
      this.worker.onmessage = ({ data }) => (data.failure ? reject(new Error(data.failure)) : resolve(data));
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

  /** A run with these parameters as the page's others are; or `reason`, why there is none. */
  async run(values) {
    const answer = await this.ask({ values: Float64Array.from(values) });
    if (answer.reason) return answer;
    const { samples } = this;
    let at = 0;
    const next = () => {
      at += samples;
      return answer.curves.subarray(at - samples, at);
    };
    const series = (count) => Array.from({ length: count }, next);
    const cues = () => ({ specific_force: series(3), angular_velocity: series(3) });
    const flags = () => Uint8Array.from(next());
    const run = {
      ...answer, times: this.times,
      desired: cues(), felt: cues(), position: series(3), orientation: series(3), legs: series(6), tilt: series(2),
      tilt_rate: series(2), lean: answer.leans ? next() : null,
      limited: { tilt: flags(), soft: flags(), safety: flags(), actuator: flags() },
    };
    const chart = ({ title, quantity, label }) => ({ title, quantity, times: this.times, lines: [{ label, values: next() }], limits: [] });
    return { ...run, charts: answer.charts.map(chart) };
  }
}
