// Numbers and ticks as people write them.

export const DEGREES = 180 / Math.PI;
const MINUS = "\u2212";

export const withMinus = (text) => text.replace("-", MINUS);

/** With so many digits after the point; no negative zero. */
export function fixed(value, digits) {
  if (!Number.isFinite(value)) return "\u2013";
  const text = value.toFixed(digits);
  return withMinus(Number(text) === 0 ? text.replace("-", "") : text);
}

/** With so many significant digits, but none beyond the sixth after the point: smaller numbers are rounding. */
export function significant(value, digits) {
  if (!Number.isFinite(value)) return "\u2013";
  if (Math.abs(value) < 1e-6) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  return fixed(value, Math.min(6, Math.max(0, digits - 1 - magnitude)));
}

/** Round values from `low` to `high`, about `count` of them, and the digits that they need. */
export function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough * 0.999);
  const values = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) values.push(k * step);
  return { values, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}
