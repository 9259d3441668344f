// Vectors as arrays of three, rotations as three rows.

export const plus = (a, b) => a.map((part, i) => part + b[i]);
export const minus = (a, b) => a.map((part, i) => part - b[i]);
export const scaled = (factor, a) => a.map((part) => factor * part);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a) => Math.sqrt(dot(a, a));
export const direction = (a) => scaled(1 / (norm(a) || 1), a);
export const turned = (rotation, a) => rotation.map((row) => dot(row, a));

/** Rz(yaw) Ry(pitch) Rx(roll). */
export function rotation(roll, pitch, yaw) {
  const [cr, sr, cp, sp, cy, sy] = [roll, pitch, yaw].flatMap((angle) => [Math.cos(angle), Math.sin(angle)]);
  return [
    [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
    [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
    [-sp, cp * sr, cp * cr],
  ];
}

/** Rx(roll). */
export const rolled = (angle) => rotation(angle, 0, 0);
