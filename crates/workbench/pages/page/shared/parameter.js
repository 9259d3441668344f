// One parameter of the panel: its name, a field, a slider with its start marked.

import { DEGREES, withMinus } from "./format.js";
import { element } from "./dom.js";
import { plainWords } from "./words.js";

const STEPS = 400;
/** A slider whose ends are farther apart goes by ratios; those of scales are not. */
const WIDE = 100;

/** With at most three digits, so that a chosen value is one that a person would write. */
const rounded = (value) => Number(value.toPrecision(3));
/** With at most four digits, as shown; the value keeps all of its digits. */
const brief = (value) => String(Number(value.toPrecision(4)));
export const inWords = (value) => withMinus(brief(value));

/** The unit of a value; of an angle with its degrees, as the curves have them. Frequencies are no angles. */
function withDegrees({ unit, text }, value) {
  const [, rest] = /^rad(\/s2?)?$/.test(unit) && !/frequency|decay/.test(text) ? unit.split("rad") : [];
  return rest === undefined ? unit : `${unit} = ${inWords(rounded(value * DEGREES))}\u00b0${rest.replace("2", "\u00b2")}`;
}

export class ParameterControl {
  /** `changed(value)` is called while a control moves, `done()` when it is let go. */
  constructor(parameter, value, changed, done) {
    this.parameter = parameter;
    const id = `parameter-${parameter.name}`;
    this.plain = plainWords(parameter) || parameter.name;
    const label = element("label", { for: id, title: parameter.text }, [this.plain]);
    this.unit = element("span", { class: "unit" });
    const unit = parameter.unit ? [" ", this.unit] : [];
    const variable = this.plain === parameter.name ? [] : [element("small", { class: "variable" }, [parameter.name])];
    this.note = element("small", { class: "idle-note" });
    const name = element("span", { class: "name" }, [label, ...unit, ...variable, this.note]);
    this.element = element("div", { class: "parameter" }, [name, ...this.controls(id, changed, done)]);
    this.show(value);
  }

  controls(id, changed, done) {
    const { kind, items } = this.parameter;
    const act = (value) => {
      changed(value);
      done();
    };
    if (kind === "enumeration") {
      this.field = element("select", { id }, items.map((item, i) => element("option", { value: String(i + 1) }, [item])));
      this.field.addEventListener("change", () => act(Number(this.field.value)));
      return [this.field];
    }
    if (kind === "boolean") {
      this.field = element("input", { id, type: "checkbox" });
      this.field.addEventListener("change", () => act(Number(this.field.checked)));
      return [this.field];
    }
    this.field = element("input", { id, type: "number", step: kind === "integer" ? "1" : "any", min: this.parameter.accepted[0], max: this.parameter.accepted[1] });
    this.field.addEventListener("change", () => {
      if (this.field.value !== "" && this.field.checkValidity()) act(Number(this.field.value));
      else this.field.reportValidity();
    });
    return [this.field, this.track(changed, done)];
  }

  track(changed, done) {
    const { text, slider: [low, high], start } = this.parameter;
    this.slider = element("input", { type: "range", min: "0", max: String(STEPS), step: "1", "aria-label": this.plain, title: text });
    this.slider.addEventListener("input", () => {
      changed(this.valueAt(Number(this.slider.value)));
    });
    this.slider.addEventListener("change", done);
    this.fitting = element("span", { class: "fitting", hidden: "" });
    const mark = element("span", { class: "start", title: `start: ${inWords(start)}`, style: this.left(start) });
    const end = (value) => element("span", { class: "end", "aria-hidden": "true" }, [inWords(value)]);
    return element("span", { class: "range" }, [end(low), element("span", { class: "slide" }, [mark, this.fitting, this.slider]), end(high)]);
  }

  get byRatio() {
    const [low, high] = this.parameter.slider;
    return low > 0 && high / low > WIDE;
  }

  /** The slider's place of a value, and the value of a place; at the start's place, the start. */
  placeOf(value) {
    const [low, high] = this.parameter.slider;
    const inside = Math.min(high, Math.max(low, value));
    const share = this.byRatio ? Math.log(inside / low) / Math.log(high / low) : (inside - low) / (high - low);
    return Math.round(share * STEPS);
  }

  valueAt(place) {
    const { slider: [low, high], kind, start } = this.parameter;
    if (place === this.placeOf(start)) return start;
    const share = place / STEPS;
    if (share === 0 || share === 1) return share ? high : low;
    const value = this.byRatio ? low * (high / low) ** share : low + share * (high - low);
    return kind === "integer" ? Math.round(value) : rounded(value);
  }

  /** The style of a mark: the middle of the knob goes from half its width to half its width before the end. */
  left(value) {
    return `left: calc(8px + ${this.placeOf(value) / STEPS} * (100% - 16px))`;
  }

  /** Marks the largest value with which the recording is felt the right way round; none without a value. */
  showFitting(value) {
    if (!this.slider) return;
    this.fitting.hidden = value === undefined;
    if (value === undefined) return;
    this.fitting.style.cssText = this.left(value);
    this.fitting.title = `felt the right way round up to ${inWords(rounded(value))}`;
  }

  show(value) {
    const { kind, unit, start } = this.parameter;
    if (kind === "boolean") this.field.checked = value !== 0;
    else this.field.value = kind === "enumeration" ? String(value) : brief(value);
    if (this.slider) {
      this.slider.value = String(this.placeOf(value));
      this.slider.setAttribute("aria-valuetext", `${inWords(value)} ${unit}, start ${inWords(start)}`);
    }
    this.unit.textContent = withDegrees(this.parameter, value);
    this.element.classList.toggle("changed", value !== start);
  }

  /** Shows that the parameter has no effect now, and why; an empty reason: it has one. */
  showIdle(reason) {
    this.element.classList.toggle("idle", Boolean(reason));
    this.note.textContent = reason;
  }
}
