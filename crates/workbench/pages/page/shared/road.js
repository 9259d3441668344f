// The road from the rider's eye, and as a map.

import { drawSegment, fitted } from "./dom.js";

/** The eye beside the rear tyre's contact, ahead and above [m], and its look down [rad]. */
const EYE = { ahead: 0.65, above: 1.5, down: 0.1 };
/** How far the road is drawn, and the nearest that is [m]. */
const FAR = 280;
const NEAR = 0.4;
/** Deceleration of a rider before a bend, as the motorcycle's [m/s2]. */
const BRAKING = 2.5;
/** Curvature from which a bend has boards and is announced [1/m], and how far ahead [m]. */
const SHARP = 0.018;
const ANNOUNCED = 160;
/** Time by which the eye looks ahead [s], the part of the turn that it takes, and its largest [rad]. */
const LOOK = { ahead: 0.9, part: 0.5, most: 0.4, time: 0.25 };

/** Colours of a road. */
export const SCENE = {
  sky: "--sky", haze: "--haze", grass: "--grass", farGrass: "--far-grass", hill: "--hill", farHill: "--far-hill", verge: "--verge",
  tarmac: "--tarmac", tarmacToo: "--tarmac-too", line: "--line", fast: "--leg-near", tooFast: "--too-fast", tyre: "--ink-on-road", trunk: "--trunk",
  leaves: "--leaves", needles: "--needles", tank: "--tank", bar: "--bar", grip: "--grip", dial: "--dial",
};

/** A number from 0 to 1 that depends on a whole one. */
const scattered = (k) => { const wave = Math.sin(12.9898 * k) * 43758.5453; return wave - Math.floor(wave); };

export class Road {
  constructor(canvas, points, halfWidth) {
    // All of it is drawn over in each frame.
    canvas.getContext("2d", { alpha: false });
    Object.assign(this, { canvas, points, halfWidth, look: 0 });
    this.spacing = Math.hypot(points[1].x - points[0].x, points[1].y - points[0].y);
    this.bends = points.map((_, k) => (this.point(k + 1).yaw - this.point(k - 1).yaw) / (2 * this.spacing));
    this.standing = [...this.posts(), ...this.trees()];
  }

  get laps() {
    return this.points.length - 1;
  }

  /** A point of the centre by its number, on any lap; headings count laps. */
  point(k) {
    const round = Math.floor(k / this.laps);
    const found = this.points[k - round * this.laps];
    return round === 0 ? found : { ...found, yaw: found.yaw + round * (this.points[this.laps].yaw - this.points[0].yaw) };
  }

  /** The next sharp bend ahead: its side, how far it is, and the advised speed in it; nothing if there is none, or in one. */
  bendAhead(distance) {
    const here = Math.floor(distance / this.spacing);
    const isSharp = (k) => Math.abs(this.bends[(k % this.laps + this.laps) % this.laps]) > SHARP;
    if (isSharp(here)) return null;
    for (let k = here + 1; (k - here) * this.spacing < ANNOUNCED; k += 1) {
      if (!isSharp(k)) continue;
      let advised = Infinity;
      for (let at = k; isSharp(at) && at < k + this.laps; at += 1) advised = Math.min(advised, this.point(at).advised);
      return { side: this.bends[k % this.laps] > 0 ? "left" : "right", ahead: (k - here) * this.spacing, advised };
    }
    return null;
  }

  /** So far to the left of a point of the centre. */
  beside(k, left) {
    const { x, y, yaw } = this.point(k);
    return [x - left * Math.sin(yaw), y + left * Math.cos(yaw)];
  }

  /** Posts along the road, and boards outside of sharp bends. */
  posts() {
    const made = [];
    for (let k = 0; k < this.laps; k += 4) {
      const bend = this.bends[k];
      const outside = (this.halfWidth + 1.6) * -Math.sign(bend);
      if (Math.abs(bend) > SHARP) made.push({ k, at: this.beside(k, outside), kind: "board", size: 1.2, side: Math.sign(bend) });
      else if (k % 12 === 0) for (const side of [1, -1]) made.push({ k, at: this.beside(k, side * (this.halfWidth + 0.8)), kind: "post", size: 1 });
    }
    return made;
  }

  /** Trees that stand nowhere on the road. */
  trees() {
    const made = [];
    for (let k = 0; k < this.laps; k += 2) {
      const side = scattered(k) < 0.5 ? -1 : 1;
      const at = this.beside(k, side * (this.halfWidth + 6 + 45 * scattered(k + 0.3) ** 2));
      const isClear = this.points.every(({ x, y }) => Math.hypot(x - at[0], y - at[1]) > this.halfWidth + 5);
      if (isClear) made.push({ k, at, kind: "tree", size: 3 + 5 * scattered(k + 0.7), isRound: scattered(k + 0.9) < 0.4 });
    }
    return made;
  }

  draw(view, isMap, paints, seconds) {
    const { context, width, height } = fitted(this.canvas);
    Object.assign(this, { context, width, height, paints });
    const here = Math.floor(view.distance / this.spacing);
    if (isMap) {
      context.fillStyle = paints.grass;
      context.fillRect(0, 0, width + 1, height + 1);
      this.drawMap(view, [24, 24, width - 48, height - 48], 9);
      return;
    }
    this.aim(view, here, seconds);
    context.save();
    context.translate(width / 2, 0.45 * height);
    context.rotate(-view.roll);
    this.drawLand();
    this.drawSurface(here);
    this.drawDashes(view, here);
    this.drawStanding(here);
    context.restore();
    this.drawCockpit(view);
    const side = Math.min(110, 0.24 * width);
    this.drawMap(view, [width - side - 12, 12, side, side], 4);
  }

  /** Makes ready for a picture from the rider's eye. */
  aim(view, here, seconds) {
    const ahead = this.point(here + Math.round(LOOK.ahead * view.speed / this.spacing)).yaw - view.yaw;
    const wanted = Math.max(-LOOK.most, Math.min(LOOK.most, LOOK.part * ahead));
    this.look += (wanted - this.look) * Math.min(1, seconds / LOOK.time);
    const yaw = view.yaw + this.look;
    const aside = -EYE.above * Math.sin(view.roll);
    this.eye = {
      x: view.x + EYE.ahead * Math.cos(view.yaw) - aside * Math.sin(view.yaw),
      y: view.y + EYE.ahead * Math.sin(view.yaw) + aside * Math.cos(view.yaw),
      z: EYE.above * Math.cos(view.roll), yaw, cos: Math.cos(yaw), sin: Math.sin(yaw),
    };
    this.focal = 0.72 * Math.max(this.width, 1.2 * this.height);
    this.horizon = -this.focal * Math.tan(EYE.down + view.pitch);
    this.reach = Math.hypot(this.width, this.height);
  }

  /** A point of the ground from the eye: ahead and to the left. */
  seen([x, y]) {
    const [dx, dy] = [x - this.eye.x, y - this.eye.y];
    return [dx * this.eye.cos + dy * this.eye.sin, dy * this.eye.cos - dx * this.eye.sin];
  }

  /** Where a point ahead and to the left, so high, is in the picture. */
  place([ahead, left], above = 0) {
    return [-this.focal * left / ahead, this.horizon - this.focal * (above - this.eye.z) / ahead];
  }

  /** Fills a shape on the ground; what is behind the eye is cut off. */
  fillGround(corners, paint) {
    const { context } = this;
    context.fillStyle = paint;
    context.beginPath();
    corners.forEach((corner, i) => {
      const before = corners[(i || corners.length) - 1];
      if ((corner[0] < NEAR) !== (before[0] < NEAR)) {
        const t = (NEAR - before[0]) / (corner[0] - before[0]);
        context.lineTo(...this.place([NEAR, before[1] + t * (corner[1] - before[1])]));
      }
      if (corner[0] >= NEAR) context.lineTo(...this.place(corner));
    });
    context.fill();
  }

  drawLand() {
    const { context, paints, reach, horizon, focal, eye } = this;
    const sky = context.createLinearGradient(0, horizon - 0.7 * reach, 0, horizon);
    sky.addColorStop(0, paints.sky);
    sky.addColorStop(1, paints.haze);
    context.fillStyle = sky;
    context.fillRect(-reach, horizon - 2 * reach, 2 * reach, 2 * reach);
    const ground = context.createLinearGradient(0, horizon, 0, horizon + 0.25 * reach);
    ground.addColorStop(0, paints.farGrass);
    ground.addColorStop(1, paints.grass);
    context.fillStyle = ground;
    context.fillRect(-reach, horizon, 2 * reach, 2 * reach);
    for (const [paint, size, wave] of [[paints.farHill, 0.075, 3], [paints.hill, 0.04, 7]]) {
      context.fillStyle = paint;
      context.beginPath();
      context.moveTo(-reach, horizon + 1);
      for (let x = -reach; x <= reach; x += reach / 40) {
        const angle = eye.yaw - Math.atan(x / focal);
        const top = 1.1 + Math.sin(wave * angle) + 0.5 * Math.sin(2 * wave * angle + 1) + 0.2 * Math.sin(5 * wave * angle);
        context.lineTo(x, horizon - focal * size * Math.max(0.1, top) / 2);
      }
      context.lineTo(reach, horizon + 1);
      context.fill();
    }
  }

  /** Numbers of the points from just behind the eye to the far end. */
  *numbers(here) {
    for (let k = here - 3; k <= here + FAR / this.spacing; k += 1) yield k;
  }

  /** A band along the road from one distance to the left to another, over these points. */
  band(numbers, from, to) {
    const side = (left) => numbers.map((k) => this.seen(this.beside(k, left)));
    return [...side(from), ...side(to).reverse()];
  }

  drawSurface(here) {
    const { paints, halfWidth: half } = this;
    const all = [...this.numbers(here)];
    this.fillGround(this.band(all, half + 1.2, -half - 1.2), paints.verge);
    this.fillGround(this.band(all, half, -half), paints.tarmac);
    // Shades by which speed is seen: of 8 m, and near.
    for (let k = 8 * Math.floor(here / 8); k < here + 60; k += 8) this.fillGround(this.band([k, k + 1, k + 2, k + 3, k + 4], half, -half), paints.tarmacToo);
    for (const side of [1, -1]) this.fillGround(this.band(all, side * (half - 0.35), side * (half - 0.2)), paints.line);
    const start = Math.round(here / this.laps) * this.laps;
    for (let row = 0; row < 2; row += 1) {
      for (let k = 0; k < 8; k += 1) {
        const [from, to] = [half * (k / 4 - 1), half * ((k + 1) / 4 - 1)];
        const at = (ahead, left) => this.seen(this.beside(start, left)).map((value, i) => value + ahead * [Math.cos(this.point(start).yaw - this.eye.yaw), Math.sin(this.point(start).yaw - this.eye.yaw)][i]);
        this.fillGround([at(row, from), at(row, to), at(row + 1, to), at(row + 1, from)], (k + row) % 2 ? paints.line : paints.tyre);
      }
    }
  }

  /** Dashes of the middle: white, or amber and red where the present speed is too much even with brakes from here on. */
  drawDashes(view, here) {
    for (const k of this.numbers(here)) {
      if ((k % 4 + 4) % 4 > 1) continue;
      const left = Math.max(0, (k - here) * this.spacing);
      const permitted = Math.sqrt(this.point(k).advised ** 2 + 2 * BRAKING * left);
      const excess = view.speed / permitted;
      const paint = excess > 1.15 ? this.paints.tooFast : excess > 1.03 ? this.paints.fast : this.paints.line;
      this.fillGround(this.band([k, k + 1], 0.09, -0.09), paint);
    }
  }

  drawStanding(here) {
    const isAhead = (k) => { const on = ((k - here) % this.laps + this.laps) % this.laps; return on * this.spacing < FAR || on > this.laps - 4; };
    const shown = this.standing.filter(({ k }) => isAhead(k)).map((one) => ({ ...one, seen: this.seen(one.at) }));
    for (const one of shown.filter(({ seen: [ahead] }) => ahead > 1.5 && ahead < FAR).sort((a, b) => b.seen[0] - a.seen[0])) {
      const [x, y] = this.place(one.seen);
      const size = this.focal * one.size / one.seen[0];
      if (size < 1.5 || Math.abs(x) > this.reach) continue;
      this.context.globalAlpha = Math.min(1, 1.6 * (1 - one.seen[0] / FAR));
      this[one.kind](x, y, size, one);
    }
    this.context.globalAlpha = 1;
  }

  post(x, y, size) {
    const { context, paints } = this;
    context.fillStyle = paints.line;
    context.fillRect(x - 0.06 * size, y - size, 0.12 * size, size);
    context.fillStyle = paints.tyre;
    context.fillRect(x - 0.06 * size, y - 0.85 * size, 0.12 * size, 0.2 * size);
  }

  board(x, y, size, { side }) {
    const { context, paints } = this;
    const [wide, high] = [0.55 * size, 0.6 * size];
    context.fillStyle = paints.tyre;
    context.fillRect(x - 0.04 * size, y - size, 0.08 * size, size);
    context.fillStyle = paints.tooFast;
    context.fillRect(x - wide / 2, y - size - high / 2, wide, high);
    context.strokeStyle = paints.line;
    context.lineWidth = Math.max(1, 0.1 * size);
    context.beginPath();
    for (const [dx, dy] of [[0.12, -0.2], [-0.12, 0], [0.12, 0.2]]) context.lineTo(x + side * dx * size, y - size + dy * size);
    context.stroke();
  }

  tree(x, y, size, { isRound }) {
    const { context, paints } = this;
    context.fillStyle = paints.trunk;
    context.fillRect(x - 0.035 * size, y - 0.35 * size, 0.07 * size, 0.35 * size);
    context.fillStyle = isRound ? paints.leaves : paints.needles;
    context.beginPath();
    if (isRound) {
      context.ellipse(x, y - 0.62 * size, 0.3 * size, 0.38 * size, 0, 0, 2 * Math.PI);
    } else {
      for (const [dx, dy] of [[-0.26, 0.2], [-0.12, 0.5], [-0.18, 0.5], [0, 1], [0.18, 0.5], [0.12, 0.5], [0.26, 0.2]]) context.lineTo(x + dx * size, y - dy * size);
    }
    context.fill();
  }

  /** Bars, mirrors and the speedometer, which stay where they are: the eye leans with the machine. */
  drawCockpit(view) {
    const { context, width, height, paints } = this;
    const unit = Math.min(width, 1.6 * height) / 100;
    context.save();
    context.translate(width / 2, height);
    context.fillStyle = paints.tank;
    context.beginPath();
    context.ellipse(0, 9 * unit, 15 * unit, 15 * unit, 0, 0, 2 * Math.PI);
    context.fill();
    context.rotate(-2 * view.steer);
    context.lineCap = "round";
    for (const side of [1, -1]) {
      context.strokeStyle = paints.bar;
      context.lineWidth = 1.6 * unit;
      context.beginPath();
      context.moveTo(0, -7 * unit);
      context.bezierCurveTo(side * 14 * unit, -6 * unit, side * 16 * unit, -11 * unit, side * 33 * unit, -5 * unit);
      context.stroke();
      const beside = (x, y) => [side * x * unit, y * unit];
      drawSegment(context, beside(24, -8), beside(30, -15), paints.bar, 0.9 * unit);
      drawSegment(context, beside(27, -7), beside(34, -4.6), paints.grip, 3 * unit);
      for (const [paint, wide, high] of [[paints.grip, 5, 2.8], [paints.haze, 4.3, 2.2]]) {
        context.fillStyle = paint;
        context.beginPath();
        context.ellipse(...beside(31, -16.5), wide * unit, high * unit, side * 0.1, 0, 2 * Math.PI);
        context.fill();
      }
    }
    this.drawDial(view, unit);
    context.restore();
  }

  drawDial({ speed }, unit) {
    const { context, paints } = this;
    context.fillStyle = paints.grip;
    context.beginPath();
    context.arc(0, -9.5 * unit, 7.5 * unit, 0, 2 * Math.PI);
    context.fill();
    const at = (kmh, radius) => { const angle = Math.PI * (0.75 + 1.5 * Math.min(1, kmh / 200)); return [radius * unit * Math.cos(angle), (radius * Math.sin(angle) - 9.5) * unit]; };
    for (let kmh = 0; kmh <= 200; kmh += 20) drawSegment(context, at(kmh, 5.4), at(kmh, 6.4), paints.dial, 0.35 * unit);
    drawSegment(context, at(3.6 * speed, -1), at(3.6 * speed, 5.6), paints.tooFast, 0.6 * unit);
  }

  /** The whole course, north up, with the motorcycle. */
  drawMap(view, [left, top, width, height], thickness) {
    const { context, points, paints } = this;
    const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
    const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = Math.min(width / (x1 - x0), height / (y1 - y0));
    const at = (x, y) => [left + width / 2 + scale * (x - (x0 + x1) / 2), top + height / 2 - scale * (y - (y0 + y1) / 2)];
    context.lineJoin = "round";
    for (const [paint, wide] of [[paints.line, thickness + 2], [paints.tarmac, thickness]]) {
      context.strokeStyle = paint;
      context.lineWidth = wide;
      context.beginPath();
      for (const { x, y } of points) context.lineTo(...at(x, y));
      context.stroke();
    }
    const [x, y] = at(view.x, view.y);
    context.fillStyle = paints.tooFast;
    context.strokeStyle = paints.line;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, 0.5 * thickness + 3, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
}
