// Vectors as arrays of three, rotations as three rows.

const plus = (a, b) => a.map((part, i) => part + b[i]);
const minus = (a, b) => a.map((part, i) => part - b[i]);
const scaled = (factor, a) => a.map((part) => factor * part);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));
const direction = (a) => scaled(1 / (norm(a) || 1), a);
const turned = (rotation, a) => rotation.map((row) => dot(row, a));

/** Rz(yaw) Ry(pitch) Rx(roll). */
function rotation(roll, pitch, yaw) {
  const [cr, sr, cp, sp, cy, sy] = [roll, pitch, yaw].flatMap((angle) => [Math.cos(angle), Math.sin(angle)]);
  return [
    [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
    [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
    [-sp, cp * sr, cp * cr],
  ];
}

/** Rx(roll). */
const rolled = (angle) => rotation(angle, 0, 0);
