// What this page asks for: commands by buttons and keys, parameters by sliders.

import { element } from "../shared/dom.js";
import { ParameterControl } from "../shared/parameter.js";
import { chosen, slotsByGroup } from "../shared/words.js";

const COMMAND_KEYS = { s: "start", e: "engage", d: "disengage", p: "park", c: "clear", escape: "stop" };
/** Headings of parameters that stand first. */
const FIRST = ["Strategy", "Scales"];
export const token = new URLSearchParams(location.search).get("token");

/** Time in which an order is answered, and times that a command is sent that is not. */
const ANSWER_TIMEOUT_MS = 700;
const COMMAND_ATTEMPTS = 5;

/** Sends what is asked for; the reason why it is refused, or nothing. A command without an answer is repeated. */
export async function ask(client, what) {
  const attempts = what.event ? COMMAND_ATTEMPTS : 1;
  for (let attempt = 0; attempt < attempts; attempt++) {
    try {
      const signal = what.event ? AbortSignal.timeout(ANSWER_TIMEOUT_MS) : undefined;
      const answer = await fetch("/ask", { method: "POST", headers: { "X-Token": token }, body: JSON.stringify({ client, ask: what }), signal });
      return answer.ok ? "" : await answer.text();
    } catch {
      // The next attempt, if there is one.
    }
  }
  return "moris-live does not answer";
}

/** Buttons and keys that call with the name of a command. */
export function listenToCommands(buttons, command, keys) {
  for (const button of buttons) button.addEventListener("click", () => command(button.dataset.event));
  addEventListener("keydown", (event) => {
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey) return;
    const key = event.key.toLowerCase();
    if (key !== "escape" && event.target.matches("input:not([type=checkbox]), select")) return;
    if (COMMAND_KEYS[key]) command(COMMAND_KEYS[key]);
    else keys[key]?.();
  });
}

/** Sliders of the tunable parameters. A change goes out at once; those that come meanwhile go together. */
export class Sliders {
  /** `send(values)` sends an object of values, and returns why they are refused, or nothing. */
  constructor(box, data, send) {
    Object.assign(this, { box, data, send, waiting: {}, isSending: false });
    this.values = data.parameters.map(({ start }) => start);
    this.controls = new Map();
    this.message = element("p", { class: "summary", role: "status" });
    this.show();
  }

  get strategy() {
    return chosen(this.data.parameters, this.values).get("strategy").value;
  }

  /** Builds the controls for the strategy: those of others have no effect. */
  show() {
    const groups = slotsByGroup(this.data.parameters, chosen(this.data.parameters, this.values).get("strategy"));
    this.controls = new Map([...groups.values()].flat().map((slot) => {
      const control = new ParameterControl(this.data.parameters[slot], this.values[slot], (value) => this.change(slot, value), () => {});
      return [slot, control];
    }));
    const byRank = ([one], [other]) => Number(FIRST.includes(other)) - Number(FIRST.includes(one));
    const parts = [...groups].sort(byRank).flatMap(([heading, slots]) => [element("h3", {}, [heading]), ...slots.map((slot) => this.controls.get(slot).element)]);
    this.box.replaceChildren(this.message, ...parts);
  }

  change(slot, value) {
    const values = this.values.with(slot, value);
    values.forEach((one, at) => { if (one !== this.values[at]) this.waiting[this.data.parameters[at].name] = one; });
    this.controls.get(slot).show(value);
    this.flush();
  }

  async flush() {
    if (this.isSending) return;
    this.isSending = true;
    while (Object.keys(this.waiting).length > 0) {
      const values = this.waiting;
      this.waiting = {};
      this.message.textContent = await this.send(values);
    }
    this.isSending = false;
  }

  /** The parameters in force, as an object of those that differ from their start. */
  take(changed) {
    if (this.isSending) return;
    const before = this.strategy;
    this.values = this.data.parameters.map(({ name, start }) => changed[name] ?? start);
    if (this.strategy !== before) this.show();
    else for (const [slot, control] of this.controls) if (!control.element.contains(document.activeElement)) control.show(this.values[slot]);
  }
}
