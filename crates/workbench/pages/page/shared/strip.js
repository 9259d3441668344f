// A curve of the last seconds: the desired force, and the felt one over it.

import { fixed } from "./format.js";
import { drawSegment, fitted } from "./dom.js";

const STRIP_TIME = 15;
/** Time between the marks of the axis [s], and the height that they take. */
const STRIP_MARKS = 5;
const STRIP_FOOT = 14;
/** Force at the ends of the axis, at least [m/s2]. */
const STRIP_FORCE = 4;

export class Strip {
  constructor(canvas) {
    this.canvas = canvas;
    this.points = [];
  }

  clear() {
    this.points = [];
  }

  push(time, desired, felt) {
    this.points.push([time, desired, felt]);
    const old = this.points.findIndex(([at]) => at >= time - STRIP_TIME);
    if (old > 60) this.points.splice(0, old);
  }

  draw(paints) {
    const { context, width, height } = fitted(this.canvas);
    const last = this.points.length ? this.points[this.points.length - 1][0] : 0;
    const most = this.points.reduce((found, [, desired, felt]) => Math.max(found, Math.abs(desired), Math.abs(felt)), STRIP_FORCE);
    const end = 2 * Math.ceil(most / 2);
    const xOf = (time) => 30 + (width - 32) * (1 - (last - time) / STRIP_TIME);
    const foot = height - STRIP_FOOT;
    const yOf = (value) => foot / 2 - value / end * (foot / 2 - 7);
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.fillStyle = paints.muted;
    for (const value of [-end, 0, end]) {
      drawSegment(context, [30, yOf(value)], [width, yOf(value)], value === 0 ? paints.axis : paints.rule, 1);
      context.fillText(fixed(value, 0), 25, yOf(value));
    }
    context.textAlign = "center";
    for (let time = STRIP_MARKS * Math.ceil((last - STRIP_TIME) / STRIP_MARKS); time <= last; time += STRIP_MARKS) {
      if (time < 0) continue;
      drawSegment(context, [xOf(time), 0], [xOf(time), foot], paints.rule, 1);
      const label = `${fixed(time, 0)} s`;
      const half = 0.5 * context.measureText(label).width;
      context.fillText(label, Math.min(width - half, Math.max(30 + half, xOf(time))), foot + 0.5 * STRIP_FOOT);
    }
    context.beginPath();
    context.rect(30, 0, width - 30, height);
    context.clip();
    for (const [which, paint, thick] of [[1, paints.desired, 4], [2, paints.felt, 2]]) {
      context.strokeStyle = paint;
      context.lineWidth = thick;
      context.lineJoin = "round";
      context.beginPath();
      for (const point of this.points) context.lineTo(xOf(point[0]), yOf(point[which]));
      context.stroke();
    }
  }
}
