// The legs against their stroke, as six gauges.

import { fixed } from "../shared/format.js";
import { element } from "../shared/dom.js";
import { actuatorsOf } from "./axes.js";
import { rgb, strokeColour } from "../shared/palette.js";

export class Gauges {
  constructor(box) {
    this.box = box;
    this.gauges = Array.from({ length: 6 }, (_, i) => {
      const needle = element("div", { class: "needle" });
      const value = element("span", { class: "value" });
      const track = element("div", { class: "track" }, [needle]);
      const name = element("span", {});
      box.append(element("div", { class: "gauge" }, [name, track, value]));
      return { needle, value, name };
    });
  }

  update(state, rig) {
    const { stroke } = rig;
    const [shortest, longest] = stroke;
    const { name: kind, title, unit, digits, shown } = actuatorsOf(rig);
    const text = (position) => `${fixed(shown([position])[0], digits)} ${unit}`;
    this.box.title = `${title} of each ${kind.toLowerCase()} between ${text(shortest)} and ${text(longest)}`;
    this.gauges.forEach(({ needle, value, name }, i) => {
      name.textContent = `${kind.toLowerCase()} ${i + 1}`;
      const fraction = (state.legs[i] - shortest) / (longest - shortest);
      needle.style.left = `${100 * Math.min(1, Math.max(0, fraction))}%`;
      needle.style.background = rgb(strokeColour(state.legs[i], stroke));
      value.textContent = text(state.legs[i]);
    });
  }
}
