// Leaves out of a curve what nobody can see.

import { indexAt } from "./data.js";

/**
 * The part of a curve between two times as points [time, value], at most four for each of `columns` pixels: the first, the
 * lowest, the highest and the last in it, so that no peak is lost. Gaps (values that are not numbers) stay gaps.
 */
export function thinned(times, values, from, to, columns) {
  const first = indexAt(times, from);
  const last = Math.min(times.length - 1, indexAt(times, to) + 1);
  const points = [];
  if (last - first <= 4 * columns) {
    for (let i = first; i <= last; i += 1) points.push([times[i], values[i]]);
    return points;
  }
  let i = first;
  while (i <= last) {
    const column = Math.floor((times[i] - from) / (to - from) * columns);
    let [lowest, highest] = [i, i];
    const start = i;
    while (i <= last && Math.floor((times[i] - from) / (to - from) * columns) === column) {
      if (values[i] < values[lowest] || Number.isNaN(values[lowest])) lowest = i;
      if (values[i] > values[highest] || Number.isNaN(values[highest])) highest = i;
      i += 1;
    }
    const kept = [...new Set([start, lowest, highest, i - 1])].sort((a, b) => a - b);
    for (const k of kept) points.push([times[k], values[k]]);
  }
  return points;
}

/** Lowest and highest of a curve's values between two times; null where there is none. */
export function extent(times, values, from, to) {
  let [low, high] = [Infinity, -Infinity];
  const last = Math.min(times.length - 1, indexAt(times, to) + 1);
  for (let i = indexAt(times, from); i <= last; i += 1) {
    if (values[i] < low) low = values[i];
    if (values[i] > high) high = values[i];
  }
  return low <= high ? [low, high] : null;
}
