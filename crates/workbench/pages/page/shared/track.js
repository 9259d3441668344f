// The road as it is learned: its line, where the preview was trusted, and the vehicle.

import { fixed } from "./format.js";
import { drawSegment, fitted } from "./dom.js";
import { setText } from "./shown.js";

/** Distance of points that are kept [m]; a longer one than the second is a jump. */
const TRACK_SPACING = [3, 40];
/** Points that are kept. */
const TRACK_POINTS = 8000;
/** Trust from which on a stretch counts as trusted. */
const TRUSTED = 0.5;

export class Track {
  /** `known` has places of the road that was loaded, a null where it is interrupted. */
  constructor(section, known) {
    this.canvas = section.querySelector("canvas");
    this.points = [];
    this.here = null;
    section.hidden = known === null;
    for (const place of known ?? []) this.points.push(place && [...place, 0]);
  }

  /** `road` is the vehicle's place, the trust in the preview, and the number of earlier passes. */
  take(road) {
    if (!road) return;
    const { place, trust, passes } = road;
    setText("road-state", passes === 0 ? "This stretch is new." : `Earlier passes here: ${passes}; trust in the preview: ${fixed(100 * trust, 0)} %.`);
    const apart = place && this.here ? Math.hypot(place[0] - this.here[0], place[1] - this.here[1]) : Infinity;
    if (!place || apart < TRACK_SPACING[0]) return;
    if (apart > TRACK_SPACING[1]) this.points.push(null);
    this.here = place;
    this.points.push([...place, trust]);
    if (this.points.length > TRACK_POINTS) this.points.splice(0, TRACK_POINTS / 8);
  }

  draw(paints) {
    if (this.canvas.closest("section").hidden) return;
    const { context, width, height } = fitted(this.canvas);
    const places = this.points.filter(Boolean);
    if (!places.length) return;
    const ends = [0, 1].map((axis) => places.reduce(([least, most], place) => [Math.min(least, place[axis]), Math.max(most, place[axis])], [Infinity, -Infinity]));
    const [across, up] = ends.map(([least, most]) => Math.max(most - least, 50));
    const scale = Math.min((width - 20) / across, (height - 20) / up);
    const at = ([x, y]) => [width / 2 + scale * (x - (ends[0][0] + ends[0][1]) / 2), height / 2 - scale * (y - (ends[1][0] + ends[1][1]) / 2)];
    for (let k = 1; k < this.points.length; k++) {
      const [from, to] = [this.points[k - 1], this.points[k]];
      if (from && to) drawSegment(context, at(from), at(to), to[2] >= TRUSTED ? paints.felt : paints.muted, to[2] >= TRUSTED ? 3 : 1.5);
    }
    if (!this.here) return;
    context.beginPath();
    context.arc(...at(this.here), 5, 0, 2 * Math.PI);
    context.fillStyle = paints.desired;
    context.fill();
  }
}
