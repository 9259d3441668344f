// A camera that turns about the machine.

import { dot, minus, plus, scaled } from "./vector.js";

const DISTANCE = 7.5;
export const HIGHEST = 1.5;

export class Camera {
  /** `rig` says what has to be in the picture. */
  constructor(rig) {
    const reach = Math.max(...rig.base.map((joint) => Math.hypot(joint[0], joint[1])));
    // A platform that hangs is below its base.
    const top = Math.max(0, rig.neutral_height + rig.head_height + 0.25);
    const bottom = Math.min(0, rig.neutral_height - 0.25);
    this.target = [0, 0, bottom + 0.48 * (top - bottom)];
    this.radius = Math.hypot(0.52 * (top - bottom), reach) + 0.05;
    this.azimuth = -0.95;
    this.elevation = 0.24;
  }

  turn(right, up) {
    this.azimuth -= right;
    this.elevation = Math.min(HIGHEST, Math.max(-0.1, this.elevation + up));
  }

  /** Makes ready for a picture of this size. */
  aim(width, height) {
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    this.back = [ce * ca, ce * sa, se];
    this.right = [-sa, ca, 0];
    this.up = [-se * ca, -se * sa, ce];
    const distance = DISTANCE / 1.75 * this.radius;
    this.eye = plus(this.target, scaled(distance, this.back));
    this.focal = 0.5 * Math.min(width, height) / Math.tan(Math.asin(this.radius / distance));
    this.middle = [width / 2, height / 2];
  }

  /** Where a point of the base frame is in the picture, and how far from the eye. */
  project(point) {
    const seen = minus(point, this.eye);
    const depth = -dot(seen, this.back);
    const scale = this.focal / depth;
    return { x: this.middle[0] + scale * dot(seen, this.right), y: this.middle[1] - scale * dot(seen, this.up), depth, scale };
  }
}
