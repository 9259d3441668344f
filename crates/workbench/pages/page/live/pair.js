// Two parameter sets: kept, gone to, and voted on.

import { setText } from "../shared/shown.js";

export class Pair {
  /** `send(what)` sends an order, and returns why it is refused, or nothing. */
  constructor(buttons, send) {
    Object.assign(this, { buttons: [...buttons], send });
    for (const button of this.buttons) button.addEventListener("click", () => this.ask(button.dataset.pair, button.dataset.set));
    /** Keys that go to a set. */
    this.keys = { 1: () => this.ask("go_to", "a"), 2: () => this.ask("go_to", "b") };
  }

  async ask(what, set) {
    const why = await this.send({ [what]: set });
    setText("pair-message", why || (what === "vote" ? `Noted: ${set.toUpperCase()} was better` : ""));
  }

  /** Shows which sets there are, and which one is in force. */
  take(told, controls) {
    for (const button of this.buttons) {
      const { pair, set } = button.dataset;
      const isThere = pair === "keep" || pair === "go_to" && told[set] || pair === "vote" && told.votes && told.a && told.b;
      button.disabled = !controls || !isThere;
      if (pair === "go_to") button.setAttribute("aria-pressed", String(told.now === set.toUpperCase()));
    }
  }
}
