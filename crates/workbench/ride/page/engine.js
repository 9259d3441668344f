// The ride in the WebAssembly, in step with the browser's clock.

const STAGES = ["ready", "riding", "off_road", "fallen", "returning"];
/** Longest time that a frame makes up for; what a stall has taken beyond it is left out [s]. */
const LONGEST_FRAME = 0.1;

class Engine {
  static async start(module, values) {
    const { instance } = await WebAssembly.instantiate(module, {});
    const engine = new Engine();
    engine.wasm = instance.exports;
    engine.hand(values);
    if (!engine.wasm.create()) throw new Error(engine.text());
    engine.names = JSON.parse(engine.text());
    engine.left = 0;
    engine.steps = 0;
    return engine;
  }

  /** Writes numbers for the module to read. Its memory may move when it grows, and is asked for after that. */
  hand(values) {
    const address = this.wasm.numbers(values.length);
    new Float64Array(this.wasm.memory.buffer, address, values.length).set(values);
  }

  text() {
    return new TextDecoder().decode(new Uint8Array(this.wasm.memory.buffer, this.wasm.text(), this.wasm.text_length()));
  }

  /** Takes parameters; the reason why it cannot, or nothing. */
  retune(values) {
    this.hand(values);
    return this.wasm.retune() ? "" : this.text();
  }

  /** Rides for so many seconds in whole milliseconds. */
  advance(seconds, { throttle, brake, stick, isHelped }) {
    this.left += Math.min(seconds, LONGEST_FRAME);
    const steps = Math.floor(1000 * this.left);
    this.left -= steps / 1000;
    this.steps += steps;
    this.wasm.advance(steps, throttle, brake, stick, isHelped);
  }

  /** What is shown, by names. */
  view() {
    const address = this.wasm.view();
    const values = new Float64Array(this.wasm.memory.buffer, address, this.names.length);
    const shown = Object.fromEntries(this.names.map((name, i) => [name, values[i]]));
    return { ...shown, stage: STAGES[shown.stage] };
  }

  /** Points of the road's centre: x, y, heading and the speed that a rider plans there. */
  road() {
    const count = this.wasm.road();
    const values = new Float64Array(this.wasm.memory.buffer, this.wasm.written(), 4 * count);
    return Array.from({ length: count }, (_, k) => {
      const [x, y, yaw, advised] = values.subarray(4 * k, 4 * k + 4);
      return { x, y, yaw, advised };
    });
  }

  restart() {
    this.wasm.restart();
  }

  lap(number) {
    return this.wasm.lap(number) ? JSON.parse(this.text()) : null;
  }

  csv() {
    return this.wasm.csv() ? this.text() : "";
  }
}
