// The controls of a vehicle that moris-live steps: sent as long as this page holds them.

import { byId } from "../shared/dom.js";
import { setText } from "../shared/shown.js";
import { Controls } from "../shared/controls.js";

/** Time between what is sent [ms]; moris-live releases the controls after 500 ms without it. */
const DRIVING_INTERVAL = 40;
export const DRIVING_KEY = "n";

export class Driving {
  /** `send(what)` sends an order, and returns why it is refused, or nothing. */
  constructor(box, handling, send) {
    Object.assign(this, { box, send, isRider: handling === "rider", controls: new Controls(), held: { throttle: 0, brake: 0, stick: 0 } });
    for (const part of box.querySelectorAll(".rider")) part.hidden = !this.isRider;
    const letters = {};
    this.controls.listen(box.querySelectorAll("#pedals button"), {}, { restart: () => this.beginAgain(), letters });
    this.controls.offerTilt(byId("tilt"));
    byId("again").addEventListener("click", () => this.beginAgain());
  }

  async beginAgain() {
    if (this.isRider) setText("driving-message", await this.send("begin_again"));
  }

  /** Sends what is held until `goesOn()` is false. */
  async run(goesOn) {
    if (this.isRunning || !goesOn()) return;
    this.isRunning = true;
    this.box.hidden = false;
    let before = performance.now();
    while (goesOn()) {
      await new Promise((resolve) => setTimeout(resolve, DRIVING_INTERVAL));
      const now = performance.now();
      this.held = this.controls.after(Math.min(0.1, (now - before) / 1000));
      before = now;
      for (const [name, value] of Object.entries(this.held)) byId(`held-${name}`).value = value;
      setText("driving-message", await this.send({ drive: { ...this.held, is_helped: this.isRider && byId("helped").checked } }));
    }
    this.box.hidden = true;
    this.isRunning = false;
  }
}
