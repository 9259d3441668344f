// The parameters that matter most, and the friction of the road.

import { element } from "../shared/dom.js";
import { ParameterControl } from "../shared/parameter.js";
import { chosen } from "../shared/words.js";

const PROMINENT = [
  "strategy", "scale.automatic", "scale.specificForce.x", "scale.specificForce.y", "scale.angularVelocity.x", "tilt.rateLimit", "tilt.angleLimit",
];
const FRICTION = {
  name: "friction of the road", text: "Friction of the tyres on the road: 1.2 dry, 0.5 wet, 0.2 snow", unit: "", kind: "real", items: [],
  accepted: [0.05, 3], slider: [0.1, 1.4], start: 1.2,
};

export class Panel {
  /** `retune(values)` and `setFriction(value)` return why a value cannot be used, or nothing. */
  constructor(box, data, { retune, setFriction }) {
    this.data = data;
    this.values = data.parameters.map(({ start }) => start);
    this.message = element("p", { class: "summary", role: "status" });
    const nothing = () => {};
    const slots = PROMINENT.map((name) => data.parameters.findIndex((parameter) => parameter.name === name));
    this.controls = new Map(slots.map((slot) => {
      const changed = (value) => this.change(slot, value, retune);
      return [slot, new ParameterControl(data.parameters[slot], this.values[slot], changed, nothing)];
    }));
    const friction = new ParameterControl(FRICTION, FRICTION.start, (value) => {
      friction.show(value);
      this.message.textContent = setFriction(value);
    }, nothing);
    box.append(element("h3", {}, ["Change while you ride"]), ...[...this.controls.values()].map((one) => one.element), friction.element, this.message);
  }

  get strategy() {
    return chosen(this.data.parameters, this.values).get("strategy").value;
  }

  change(slot, value, retune) {
    const values = this.values.with(slot, value);
    const reason = retune(values);
    this.message.textContent = reason && `Cannot be used: ${reason}`;
    if (!reason) this.values = values;
    for (const [shown, control] of this.controls) control.show(this.values[shown]);
  }
}
