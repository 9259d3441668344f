// A chart over time: curves, limits, a legend with the values at the cursor. All charts share the times shown.

import { fixed, ticks } from "../shared/format.js";
import { drawSegment, element, fitted, setAttributes } from "../shared/dom.js";
import { colour } from "../shared/palette.js";
import { inWords } from "../shared/parameter.js";
import { valueAt } from "./data.js";
import { extent, thinned } from "./thin.js";

export const MARGIN = { left: 52, right: 10, top: 8, bottom: 22 };

/** The x of a time in a plot so wide, and back. */
export const plotWidth = (width) => width - MARGIN.left - MARGIN.right;
export const xOf = (time, [from, to], width) => MARGIN.left + (time - from) / (to - from) * plotWidth(width);
const timeOf = (x, [from, to], width) => from + (x - MARGIN.left) / plotWidth(width) * (to - from);

/** How much a turn of the wheel zooms. */
const WHEEL = 1.0015;

/**
 * A plot's canvas with a cursor line over it. A click sets the time, a drag chooses the times shown, a drag with shift moves
 * them; the wheel with control zooms, with shift it moves. The pointer reads the curves.
 */
export class Plot {
  constructor(height, shown, { seek, show, hover }) {
    this.canvas = element("canvas", { role: "img" });
    this.cursor = element("div", { class: "cursor" });
    this.reader = element("div", { class: "reader", hidden: "" });
    this.selection = element("div", { class: "selection", hidden: "" });
    this.box = element("div", { class: "plot", style: `height: ${height}px` }, [this.canvas, this.selection, this.cursor, this.reader]);
    this.shown = shown;
    this.listen(seek, show, hover);
  }

  /** The width when it was drawn: to ask for it after each change of a text would lay the page out each time. */
  get width() {
    return this.drawnWidth ?? this.box.clientWidth;
  }

  /** The canvas, cleared and as fine as the screen. */
  fitted() {
    const made = fitted(this.canvas);
    this.drawnWidth = made.width;
    return made;
  }

  moveCursor(time, cursor = this.cursor) {
    const [from, to] = this.shown();
    cursor.hidden = time === null || time < from || time > to;
    cursor.style.transform = `translateX(${xOf(time, [from, to], this.width)}px)`;
  }

  listen(seek, show, hover) {
    let start = null;
    let moved = null;
    const xIn = (event) => event.clientX - this.box.getBoundingClientRect().left;
    const clamped = (x) => Math.min(this.width - MARGIN.right, Math.max(MARGIN.left, x));
    this.box.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.box.setPointerCapture(event.pointerId);
      if (event.shiftKey) moved = { x: xIn(event), times: this.shown() };
      else start = clamped(xIn(event));
    });
    this.box.addEventListener("pointermove", (event) => {
      if (moved) {
        const by = timeOf(moved.x, moved.times, this.width) - timeOf(xIn(event), moved.times, this.width);
        show(moved.times.map((time) => time + by));
        return;
      }
      hover(timeOf(clamped(xIn(event)), this.shown(), this.width));
      if (start === null) return;
      const x = clamped(xIn(event));
      this.selection.hidden = Math.abs(x - start) < 5;
      this.selection.style.left = `${Math.min(x, start)}px`;
      this.selection.style.width = `${Math.abs(x - start)}px`;
    });
    this.box.addEventListener("pointerleave", () => hover(null));
    this.box.addEventListener("wheel", (event) => {
      const [from, to] = this.shown();
      const span = to - from;
      if (event.ctrlKey || event.metaKey) {
        const at = timeOf(clamped(xIn(event)), [from, to], this.width);
        const factor = WHEEL ** event.deltaY;
        show([at - (at - from) * factor, at + (to - at) * factor]);
      } else if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        const by = (event.deltaX || event.deltaY) / this.width * span;
        show([from + by, to + by]);
      } else {
        return;
      }
      event.preventDefault();
    }, { passive: false });
    this.box.addEventListener("pointerup", (event) => {
      moved = null;
      if (start === null) return;
      const times = [start, clamped(xIn(event))].sort((a, b) => a - b).map((x) => timeOf(x, this.shown(), this.width));
      if (this.selection.hidden) seek(times[1]);
      else show(times);
      this.selection.hidden = true;
      start = null;
    });
    this.box.addEventListener("pointercancel", () => {
      this.selection.hidden = true;
      start = null;
      moved = null;
    });
    this.box.addEventListener("dblclick", () => show(null));
  }
}

/** Draws the time axis below a plot. */
export function drawTimeAxis(context, shown, width, height, from = MARGIN.top) {
  const { values, digits } = ticks(shown[0], shown[1], Math.max(3, plotWidth(width) / 90));
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const time of values) {
    const x = Math.round(xOf(time, shown, width)) + 0.5;
    drawSegment(context, [x, from], [x, height - MARGIN.bottom], colour("--rule"), 1);
    context.fillStyle = colour("--muted");
    const unit = time === values[values.length - 1] ? " s" : "";
    context.fillText(fixed(time, digits) + unit, Math.min(x, width - 18), height - MARGIN.bottom + 6);
  }
}

/** Time after the beginning of a ride in which a jolt does not set the vertical axis [s], and how much larger it is. */
const JOLT = { time: 1, factor: 3 };

/** Lowest and highest of a curve; without its first second, where that alone makes it several times as large. */
function usualExtent({ times, values }, from, to) {
  const whole = extent(times, values, from, to);
  const settled = times[0] + JOLT.time;
  if (!whole || from > times[0] || to <= 2 * JOLT.time + times[0]) return whole;
  const later = extent(times, values, settled, to);
  return later && whole[1] - whole[0] > JOLT.factor * (later[1] - later[0]) && later[1] > later[0] ? later : whole;
}

/** True for curves with the same points, but for rounding. */
function areEqual(one, other) {
  const near = (a, b) => Math.abs(a - b) <= 1e-5 + 1e-5 * Math.abs(a) || (Number.isNaN(a) && Number.isNaN(b));
  const same = (a, b) => a === b || (a.length === b.length && a.every((value, i) => near(value, b[i])));
  return one.values.length > 0 && same(one.values, other.values) && same(one.times, other.times);
}

export class Chart {
  /**
   * `lines`: { label, colour, width, dash, times, values }, `aside` for those in the background, and `layer`, higher on top
   * of lower; `others`: curves that are not drawn but set the vertical axis, too; `limits`: values of dashed lines; `unit`
   * stands in the title; `least`: the smallest span of the vertical axis.
   */
  constructor({ title, unit, lines, others = [], limits = [], least = 1e-3, height = 150, digits = 2 }, shown, handlers) {
    Object.assign(this, { lines, others, limits, least, digits });
    this.plot = new Plot(height, shown, handlers);
    this.shown = shown;
    this.legend = lines.map((line) => {
      const [value, same] = [element("span", { class: "value" }), element("span", {})];
      return { line, value, same, entry: element("li", {}, [swatch(line), line.label, " ", same, value]) };
    });
    this.nameEqual();
    if (limits.length > 0) {
      const line = { colour: "--limit", width: 1.5, dash: [5, 4] };
      this.legend.push({ entry: element("li", {}, [swatch(line), "limit"]) });
    }
    const heading = element("h3", {}, [title, " ", element("span", { class: "unit" }, [unit])]);
    const legend = element("ul", { class: "legend" }, this.legend.map(({ entry }) => entry));
    this.element = element("figure", { class: "chart" }, [element("figcaption", {}, [heading, legend]), this.plot.box]);
    this.element.dataset.title = title;
    this.spoken = () => this.inWords(title, unit);
  }

  /** Takes other curves and limits, as many as there are. */
  take({ lines, others = [], limits = [] }) {
    Object.assign(this, { lines, others, limits });
    lines.forEach((line, i) => { this.legend[i].line = line; });
    this.nameEqual();
  }

  /** The curves from the lowest to the highest layer; of equal ones the highest. */
  get drawn() {
    const sorted = [...this.lines].sort((a, b) => (a.layer || 0) - (b.layer || 0));
    return sorted.filter((line, i) => !sorted.slice(i + 1).some((above) => areEqual(line, above)));
  }

  /** The legend names the curve that is drawn in the place of an equal one. */
  nameEqual() {
    const drawn = this.drawn;
    for (const { line, same } of this.legend) {
      if (line) same.textContent = drawn.includes(line) ? "" : `(as ${drawn.find((above) => areEqual(line, above)).label}) `;
    }
  }

  /** The chart in words, for readers of screens. */
  inWords(title, unit) {
    const [from, to] = this.shown();
    const ranges = this.lines.map(({ label, times, values }) => {
      const found = extent(times, values, from, to);
      return found ? `${label} from ${found.map((value) => fixed(value, this.digits)).join(" to ")}` : `${label} without values`;
    });
    return `${title} over time, in ${unit}: ${ranges.join("; ")}`;
  }

  /** The pointer's time, whose values the legend shows; null: those of the cursor's. */
  read(time, cursor) {
    this.plot.moveCursor(time, this.plot.reader);
    this.showValues(time === null ? cursor : time);
  }

  moveCursor(time) {
    this.plot.moveCursor(time);
    this.showValues(time);
  }

  showValues(time) {
    for (const { line, value } of this.legend) {
      if (line) value.textContent = fixed(valueAt(line.times, line.values, time), this.digits);
    }
  }

  /** Lowest and highest value of the vertical axis. */
  range() {
    const [from, to] = this.shown();
    const extents = [...this.lines, ...this.others].map((line) => usualExtent(line, from, to)).filter(Boolean);
    const all = [...extents.flat(), ...this.limits];
    if (all.length === 0) return [-1, 1];
    const [low, high] = [Math.min(...all), Math.max(...all)];
    const missing = Math.max(0, this.least - (high - low));
    const margin = 0.07 * Math.max(high - low, this.least);
    return [low - missing / 2 - margin, high + missing / 2 + margin];
  }

  draw() {
    const { context, width, height } = this.plot.fitted();
    const shown = this.shown();
    this.plot.canvas.setAttribute("aria-label", this.spoken());
    const [low, high] = this.range();
    const bottom = height - MARGIN.bottom;
    const yOf = (value) => bottom - (value - low) / (high - low) * (bottom - MARGIN.top);
    drawTimeAxis(context, shown, width, height);
    this.drawValueAxis(context, width, yOf, ticks(low, high, Math.max(2, (bottom - MARGIN.top) / 24)));
    context.save();
    context.beginPath();
    context.rect(MARGIN.left, MARGIN.top - 3, plotWidth(width), bottom - MARGIN.top + 6);
    context.clip();
    for (const limit of this.limits) {
      const level = { times: shown, values: [limit, limit], colour: "--limit", width: 1.5, dash: [5, 4] };
      drawLine(context, level, shown, width, yOf);
    }
    for (const line of this.drawn) drawLine(context, line, shown, width, yOf);
    context.restore();
  }

  drawValueAxis(context, width, yOf, { values, digits }) {
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const value of values) {
      const y = Math.round(yOf(value)) + 0.5;
      const zero = Math.abs(value) < 1e-12;
      drawSegment(context, [MARGIN.left, y], [width - MARGIN.right, y], colour(zero ? "--axis" : "--rule"), 1);
      context.fillStyle = colour("--muted");
      context.fillText(fixed(value, digits), MARGIN.left - 8, y);
    }
  }
}

function drawLine(context, line, shown, width, yOf) {
  context.strokeStyle = colour(line.colour);
  context.globalAlpha = line.aside ? 0.6 : 1;
  context.lineWidth = line.width;
  context.lineJoin = "round";
  context.setLineDash(line.dash || []);
  context.beginPath();
  let pen = false;
  for (const [time, value] of thinned(line.times, line.values, shown[0], shown[1], plotWidth(width))) {
    if (Number.isFinite(value)) {
      const [x, y] = [xOf(time, shown, width), yOf(value)];
      if (pen) context.lineTo(x, y);
      else context.moveTo(x, y);
    }
    pen = Number.isFinite(value);
  }
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/** A line's sample for the legend. */
function swatch({ colour: name, width, dash = [] }) {
  const made = document.createElement("template");
  made.innerHTML = '<svg class="swatch" width="26" height="6" aria-hidden="true"><line x1="0" y1="3" x2="26" y2="3"/></svg>';
  const sample = made.content.firstChild;
  setAttributes(sample.firstChild, { style: `stroke: var(${name})`, "stroke-width": Math.min(width, 4), "stroke-dasharray": dash.join(" ") });
  return sample;
}
