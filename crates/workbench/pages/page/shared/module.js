// The WebAssembly's side of numbers and a text.

export class Module {
  static async start(bytes) {
    const { instance } = await WebAssembly.instantiate(bytes, {});
    return Object.assign(new Module(), { calls: instance.exports });
  }

  /** Writes numbers for the module to read. Its memory may move when it grows, and is asked for after that. */
  hand(values) {
    this.view(Float64Array, this.calls.numbers(values.length), values.length).set(values);
  }

  text() {
    return new TextDecoder().decode(this.view(Uint8Array, this.calls.text(), this.calls.text_length()));
  }

  /** So many numbers of the module's memory at an address. */
  view(Numbers, address, count) {
    return new Numbers(this.calls.memory.buffer, address, count);
  }
}
