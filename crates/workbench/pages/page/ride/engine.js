// The ride in the WebAssembly, in step with the browser's clock.

import { Module } from "../shared/module.js";

const STAGES = ["ready", "riding", "off_road", "fallen", "returning"];
/** Longest time that a frame makes up for; what a stall has taken beyond it is left out [s]. */
const LONGEST_FRAME = 0.1;

export class Engine {
  static async start(bytes, values) {
    const engine = Object.assign(new Engine(), { module: await Module.start(bytes), left: 0, steps: 0 });
    engine.module.hand(values);
    if (!engine.calls.create()) throw new Error(engine.module.text());
    engine.names = JSON.parse(engine.module.text());
    return engine;
  }

  get calls() {
    return this.module.calls;
  }

  /** Takes parameters; the reason why it cannot, or nothing. */
  retune(values) {
    this.module.hand(values);
    return this.calls.retune() ? "" : this.module.text();
  }

  /** Rides for so many seconds in whole milliseconds. */
  advance(seconds, { throttle, brake, stick, isHelped }) {
    this.left += Math.min(seconds, LONGEST_FRAME);
    const steps = Math.floor(1000 * this.left);
    this.left -= steps / 1000;
    this.steps += steps;
    this.calls.advance(steps, throttle, brake, stick, isHelped);
  }

  /** What is shown, by names. */
  view() {
    const values = this.module.view(Float64Array, this.calls.view(), this.names.length);
    const shown = Object.fromEntries(this.names.map((name, i) => [name, values[i]]));
    return { ...shown, stage: STAGES[shown.stage] };
  }

  /** Points of the road's centre: x, y, heading and the speed that a rider plans there. */
  road() {
    const count = this.calls.road_length();
    const values = this.module.view(Float64Array, this.calls.road(), 4 * count);
    return Array.from({ length: count }, (_, k) => {
      const [x, y, yaw, advised] = values.subarray(4 * k, 4 * k + 4);
      return { x, y, yaw, advised };
    });
  }

  restart() {
    this.calls.restart();
  }

  lap(number) {
    return this.calls.lap(number) ? JSON.parse(this.module.text()) : null;
  }

  csv() {
    return this.calls.csv() ? this.module.text() : "";
  }
}
