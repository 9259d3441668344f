// The machine in a pose: where its joints, its legs, the mock-up and the rider are, in the base frame.

import { plus, rolled, turned } from "./vector.js";

/** A point of the platform in the base frame. */
export const onPlatform = (state, point) => plus(state.position, turned(state.rotation, point));

/** Both ends of each leg; of a crank the axle, the end of the arm and the joint. */
export const legEnds = (rig, state) => rig.base.map((joint, i) => {
  const top = onPlatform(state, rig.platform[i]);
  if (!rig.cranks) return [joint, top];
  const { arm, heading } = rig.cranks;
  const angle = state.legs[i] / arm;
  const level = arm * Math.cos(angle);
  return [joint, plus(joint, [level * Math.cos(heading[i]), level * Math.sin(heading[i]), arm * Math.sin(angle)]), top];
});

/** A point of the rider's torso, `height` above the seat along the back, `aside` to the left and `ahead`: it leans with the rider. */
export function onTorso(rig, state, height, aside = 0, ahead = 0) {
  const seat = [0, 0, rig.head_height - rig.torso_length];
  return onPlatform(state, plus(seat, turned(rolled(state.lean), [ahead, aside, height])));
}

/** The rider's head: the point where the washout's specific force is felt. */
export const headOf = (rig, state) => onTorso(rig, state, rig.torso_length);

/** A vector in the head's axes, in the base frame. */
export const fromHead = (state, a) => turned(state.rotation, turned(rolled(state.lean), a));

// The mock-ups in side view, as x and z in units of the seat's height above the platform, and half their widths. A wheel has
// its centre's y as third coordinate.
const MOTORCYCLE = {
  body: [
    { half: 0.20, colour: "--mock-up", outline: [[-0.45, 0.30], [0.35, 0.26], [0.62, 0.70], [0.50, 0.98], [-0.10, 0.92]] },
    { half: 0.16, colour: "--tank", outline: [[0.02, 0.92], [0.60, 0.86], [0.66, 1.10], [0.46, 1.22], [0.10, 1.14]] },
    { half: 0.18, colour: "--seat", outline: [[-0.98, 1.02], [-0.60, 0.88], [0.08, 0.92], [0.10, 1.04], [-0.50, 1.02], [-0.94, 1.14]] },
  ],
  wheels: [{ centre: [1.28, 0.52, 0], radius: 0.5 }, { centre: [-1.12, 0.52, 0], radius: 0.5 }],
  rods: [[[1.28, 0.52, 0], [0.70, 1.34, 0]]],
  bar: { at: [0.66, 1.38], half: 0.62 },
  legs: { knee: [0.42, 0.98], foot: [-0.22, 0.34] },
};
const CAR = {
  body: [
    { half: 0.92, colour: "--tank", outline: [[-1.85, 0.38], [2.25, 0.38], [2.35, 0.70], [1.20, 1.02], [-1.10, 1.02], [-1.85, 0.92]] },
    { half: 0.30, colour: "--seat", outline: [[-0.42, 1.00], [-0.26, 1.00], [-0.40, 2.05], [-0.58, 2.05]] },
  ],
  wheels: [1.50, -1.20].flatMap((x) => [0.95, -0.95].map((y) => ({ centre: [x, 0.42, y], radius: 0.4 }))),
  rods: [
    ...[0.85, -0.85].map((y) => [[1.20, 1.02, y], [0.78, 1.80, 0.85 * y]]),
    [[0.78, 1.80, 0.72], [0.78, 1.80, -0.72]],
  ],
  bar: { at: [0.62, 1.42], half: 0.28 },
};
export const MOCK_UPS = { motorcycle: MOTORCYCLE, car: CAR };

/** A flat shape swept across: its two sides and the strip between them, as polygons of points on the platform. */
export function swept(outline, half, size) {
  const side = (y) => outline.map(([x, z]) => [size * x, y * size, size * z]);
  const [left, right] = [side(half), side(-half)];
  const strip = outline.map((_, i) => {
    const next = (i + 1) % outline.length;
    return [left[i], left[next], right[next], right[i]];
  });
  return [left, right.slice().reverse(), ...strip];
}

/** A ring of points on the platform, standing along its x axis. */
export function wheel({ centre: [x, z, y], radius }, size) {
  return Array.from({ length: 29 }, (_, k) => {
    const angle = k / 28 * 2 * Math.PI;
    return [size * (x + radius * Math.cos(angle)), size * y, size * (z + radius * Math.sin(angle))];
  });
}

/** A plate with corners at the joints, so thick, below them. */
export function plate(joints, thickness) {
  const around = joints.slice().sort((a, b) => Math.atan2(a[1], a[0]) - Math.atan2(b[1], b[0]));
  const below = around.map(([x, y, z]) => [x, y, z - thickness]);
  const rim = around.map((_, i) => {
    const next = (i + 1) % around.length;
    return [around[i], below[i], below[next], around[next]];
  });
  return [around, below.slice().reverse(), ...rim];
}
