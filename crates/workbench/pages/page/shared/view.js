// The machine, drawn: what is farther from the eye first, so that what is nearer covers it.

import { byId, drawSegment, element, fitted } from "./dom.js";
import { channels, colour, mixed, rgb, strokeColour } from "./palette.js";
import { cross, direction, dot, minus, norm, plus, scaled } from "./vector.js";
import { fromHead, headOf, legEnds, MOCK_UPS, onPlatform, onTorso, plate, swept, wheel } from "./machine.js";
import { Camera, HIGHEST } from "./camera.js";

const LIGHT = direction([0.35, -0.6, 0.75]);
/** Length of an arrow for 1 m/s2 [m]. */
const ARROW = 0.12;
const ARROW_WORTH_DRAWING = 0.1;
const GRAVITY = 9.80665;

export class View {
  constructor(canvas, rig, vehicle) {
    this.canvas = canvas;
    this.rig = rig;
    this.mockUp = MOCK_UPS[vehicle];
    this.camera = new Camera(rig);
    /** As drawn last: both ends of each leg and the middle of the head, in the picture. */
    this.drawnLegs = [];
    this.drawnHead = [];
  }

  /** The machine in a state; `felt` is the colour of the felt force. */
  drawState(state, felt) {
    const { context, width, height } = fitted(this.canvas);
    this.context = context;
    this.camera.aim(width, height);
    this.parts = [];
    context.lineCap = "round";
    context.lineJoin = "round";
    this.drawFloor();
    this.addPlates(state);
    this.addLegs(state);
    this.addMockUp(state);
    this.addRider(state);
    this.parts.sort((a, b) => b.depth - a.depth).forEach((part) => part.draw());
    this.drawArrows(state, felt);
    this.drawCompass(height);
  }

  // What can be drawn: polygons, rods and balls.

  add(points, draw) {
    const depth = points.reduce((sum, point) => sum + this.camera.project(point).depth, 0) / points.length;
    this.parts.push({ depth, draw });
  }

  path(points) {
    this.context.beginPath();
    for (const point of points) {
      const { x, y } = this.camera.project(point);
      this.context.lineTo(x, y);
    }
  }

  addPolygon(points, paint) {
    const normal = direction(cross(minus(points[1], points[0]), minus(points[2], points[0])));
    const bright = 0.5 + 0.5 * Math.abs(dot(normal, LIGHT));
    const filled = rgb(mixed(mixed(paint, [0, 0, 0], 0.45), paint, bright));
    this.add(points, () => {
      this.path(points);
      this.context.closePath();
      this.context.fillStyle = filled;
      this.context.strokeStyle = filled;
      this.context.lineWidth = 0.7;
      this.context.fill();
      this.context.stroke();
    });
  }

  /** A line through points, so thick [m]. */
  addRod(points, thickness, paint) {
    this.add(points, () => {
      this.path(points);
      const { scale } = this.camera.project(points[0]);
      this.context.strokeStyle = rgb(paint);
      this.context.lineWidth = Math.max(1, thickness * scale);
      this.context.stroke();
    });
  }

  addBall(centre, radius, paint) {
    this.add([centre], () => {
      const { x, y, scale } = this.camera.project(centre);
      const r = radius * scale;
      const shade = this.context.createRadialGradient(x - 0.35 * r, y - 0.4 * r, 0.1 * r, x, y, r);
      shade.addColorStop(0, rgb(mixed(paint, [255, 255, 255], 0.35)));
      shade.addColorStop(1, rgb(mixed(paint, [0, 0, 0], 0.15)));
      this.context.beginPath();
      this.context.arc(x, y, r, 0, 2 * Math.PI);
      this.context.fillStyle = shade;
      this.context.fill();
    });
  }

  // What there is to draw.

  drawFloor() {
    const half = 1.5;
    this.context.strokeStyle = colour("--floor");
    this.context.lineWidth = 1;
    for (let k = -3; k <= 3; k += 1) {
      const at = k * half / 3;
      for (const ends of [[[at, -half, 0], [at, half, 0]], [[-half, at, 0], [half, at, 0]]]) {
        this.path(ends);
        this.context.stroke();
      }
    }
  }

  addPlates(state) {
    const paint = channels(colour("--plate"));
    const thin = this.rig.cranks ? Math.min(1, this.rig.cranks.arm / 0.15) : 1;
    for (const face of plate(this.rig.base, 0.03 * thin)) this.addPolygon(face, paint);
    for (const face of plate(this.rig.platform, 0.05 * thin)) this.addPolygon(face.map((point) => onPlatform(state, point)), paint);
  }

  addLegs(state) {
    const { cranks, stroke } = this.rig;
    const ends = legEnds(this.rig, state);
    const size = cranks ? Math.min(1, cranks.arm / 0.15) : 1;
    ends.forEach((points, i) => {
      const [foot, top] = [points[0], points.at(-1)];
      // Parked legs are meant to be at their end.
      const paint = state.parked ? channels(colour("--leg-easy")) : strokeColour(state.legs[i], stroke);
      const along = direction(minus(top, foot));
      const mouth = cranks ? points[1] : plus(foot, scaled(0.62 * stroke[0], along));
      this.addRod([mouth, top], 0.035 * size, mixed(paint, [255, 255, 255], 0.35));
      this.addRod([foot, mouth], 0.075 * size, paint);
      this.addBall(foot, 0.045 * size, paint);
      this.addBall(top, 0.04 * size, paint);
    });
    this.drawnLegs = ends.map((pair) => pair.map((point) => this.camera.project(point)).map(({ x, y }) => [x, y]));
  }

  addMockUp(state) {
    const size = this.rig.head_height - this.rig.torso_length;
    if (size < 0.1) return;
    const place = ([x, z, y = 0], aside = y) => onPlatform(state, [size * x, size * aside, size * z]);
    const { body, wheels, rods, bar } = this.mockUp;
    for (const { outline, half, colour: name } of body) {
      for (const face of swept(outline, half, size)) {
        this.addPolygon(face.map((point) => onPlatform(state, point)), channels(colour(name)));
      }
    }
    const dark = channels(colour("--tyre"));
    for (const one of wheels) {
      const ring = wheel(one, size).map((point) => onPlatform(state, point));
      for (let k = 0; k + 7 < ring.length; k += 7) this.addRod(ring.slice(k, k + 8), 0.14 * size, dark);
      this.addBall(place(one.centre), 0.1 * size, dark);
    }
    for (const ends of rods) this.addRod(ends.map((end) => place(end)), 0.1 * size, dark);
    this.addRod([place(bar.at, bar.half), place(bar.at, -bar.half)], 0.07 * size, dark);
  }

  addRider(state) {
    const { rig } = this;
    const size = rig.head_height - rig.torso_length;
    const [suit, helmet] = ["--rider", "--helmet"].map((name) => channels(colour(name)));
    const shoulders = [0.17, -0.17].map((aside) => onTorso(rig, state, 0.74 * rig.torso_length, aside, -0.06));
    if (size >= 0.1) {
      for (const [i, side] of [1, -1].entries()) {
        const place = ([x, z], y) => onPlatform(state, [size * x, side * size * y, size * z]);
        const { legs, bar } = this.mockUp;
        if (legs) {
          const hip = onTorso(rig, state, 0.08, side * 0.09, -0.2);
          this.addRod([hip, place(legs.knee, 0.5)], 0.11, suit);
          this.addRod([place(legs.knee, 0.5), place(legs.foot, 0.42)], 0.09, suit);
        }
        const hand = place(bar.at, bar.half);
        const elbow = plus(scaled(0.5, plus(shoulders[i], hand)), scaled(-0.09, state.rotation.map((row) => row[2])));
        this.addRod([shoulders[i], elbow, hand], 0.075, suit);
      }
    }
    const back = [onTorso(rig, state, 0.1, 0, -0.2), onTorso(rig, state, 0.6 * rig.torso_length, 0, -0.1)];
    this.addRod(back, 0.25, suit);
    this.addRod(shoulders, 0.15, suit);
    const head = headOf(rig, state);
    this.addBall(head, 0.135, helmet);
    const { x, y } = this.camera.project(head);
    this.drawnHead = [x, y];
    const visor = [0.5, 0.25, 0, -0.25, -0.5].map((angle) => {
      const towards = [Math.cos(angle), Math.sin(angle), 0.05];
      return plus(head, scaled(0.137, direction(fromHead(state, towards))));
    });
    if (dot(minus(visor[2], head), this.camera.back) > -0.03) this.addRod(visor.map((point) => plus(point, scaled(0.02, this.camera.back))), 0.06, channels(colour("--visor")));
  }

  /** What is desired and what is felt at the head, less gravity along its vertical. */
  drawArrows(state, felt) {
    const head = headOf(this.rig, state);
    const cues = [[state.desired, colour("--desired"), 7], [state.felt, felt, 3]];
    for (const [force, paint, wide] of cues) {
      const cue = minus(force, [0, 0, GRAVITY]);
      if (norm(cue) < ARROW_WORTH_DRAWING) continue;
      this.drawArrow(head, plus(head, scaled(ARROW, fromHead(state, cue))), paint, wide);
    }
  }

  drawArrow(from, to, paint, wide) {
    const [a, b] = [from, to].map((point) => this.camera.project(point));
    const long = Math.hypot(b.x - a.x, b.y - a.y);
    if (long < 2) return;
    const [ux, uy] = [(b.x - a.x) / long, (b.y - a.y) / long];
    const tip = Math.min(long, 6 + wide);
    const { context } = this;
    drawSegment(context, [a.x, a.y], [b.x - tip * ux, b.y - tip * uy], paint, wide);
    context.fillStyle = paint;
    context.beginPath();
    context.moveTo(b.x, b.y);
    context.lineTo(b.x - tip * ux - 0.6 * tip * uy, b.y - tip * uy + 0.6 * tip * ux);
    context.lineTo(b.x - tip * ux + 0.6 * tip * uy, b.y - tip * uy - 0.6 * tip * ux);
    context.fill();
  }

  /** Which way the axes point. */
  drawCompass(height) {
    const { context, camera } = this;
    const [x, y, long] = [34, height - 34, 22];
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = colour("--muted");
    for (const [axis, name] of [[[1, 0, 0], "x"], [[0, 1, 0], "y"], [[0, 0, 1], "z"]]) {
      const [dx, dy] = [dot(axis, camera.right), -dot(axis, camera.up)];
      drawSegment(context, [x, y], [x + long * dx, y + long * dy], colour("--muted"), 1.5);
      if (Math.hypot(dx, dy) > 0.25) context.fillText(name, x + (long + 8) * dx, y + (long + 8) * dy);
    }
  }
}

const VIEWS = { oblique: [-0.95, 0.24], side: [-Math.PI / 2, 0.05], front: [0, 0.05], above: [-Math.PI / 2, HIGHEST] };

/** Lets the mouse, a finger or the arrow keys turn the view; `changed` is called when they do. */
export function letTurn(view, changed) {
  const { canvas, camera } = view;
  let last = null;
  canvas.addEventListener("pointerdown", (event) => {
    last = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!last) return;
    camera.turn(0.008 * (event.clientX - last[0]), 0.008 * (event.clientY - last[1]));
    last = [event.clientX, event.clientY];
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { last = null; });
  canvas.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (!turn) return;
    event.preventDefault();
    event.stopPropagation();
    camera.turn(...turn);
    changed();
  });
  for (const [name, [azimuth, elevation]] of Object.entries(VIEWS)) {
    const button = element("button", { type: "button" }, [name]);
    button.addEventListener("click", () => {
      Object.assign(camera, { azimuth, elevation });
      changed();
    });
    byId("views").append(button);
  }
}
