// The legs against their stroke, as six gauges.

import { fixed } from "../shared/format.js";
import { element } from "../shared/dom.js";
import { rgb, strokeColour } from "../shared/palette.js";

export class Gauges {
  constructor(box) {
    this.box = box;
    this.gauges = Array.from({ length: 6 }, (_, i) => {
      const needle = element("div", { class: "needle" });
      const value = element("span", { class: "value" });
      const track = element("div", { class: "track" }, [needle]);
      box.append(element("div", { class: "gauge" }, [element("span", {}, [`leg ${i + 1}`]), track, value]));
      return { needle, value };
    });
  }

  update(state, stroke) {
    const [shortest, longest] = stroke;
    this.box.title = `Length of each leg between ${fixed(shortest, 3)} and ${fixed(longest, 3)} m`;
    this.gauges.forEach(({ needle, value }, i) => {
      const fraction = (state.legs[i] - shortest) / (longest - shortest);
      needle.style.left = `${100 * Math.min(1, Math.max(0, fraction))}%`;
      needle.style.background = rgb(strokeColour(state.legs[i], stroke));
      value.textContent = `${fixed(state.legs[i], 3)} m`;
    });
  }
}
