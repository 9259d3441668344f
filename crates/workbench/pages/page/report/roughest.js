// The second to look at first: an RMS error hides a jolt, and a curve of minutes hides it, too.

/**
 * Start of the second in which felt surge or sway has least of the desired one's shape: where the standard deviation of their
 * difference is largest.
 */
export function roughestSecond({ times, desired, felt }) {
  let [largest, start] = [-1, times[0]];
  for (const axis of [0, 1]) {
    const error = (k) => felt.specific_force[axis][k] - desired.specific_force[axis][k];
    let [first, sum, squares] = [0, 0, 0];
    for (let k = 0; k < times.length; k += 1) {
      sum += error(k);
      squares += error(k) ** 2;
      for (; times[k] - times[first] > 1; first += 1) {
        sum -= error(first);
        squares -= error(first) ** 2;
      }
      const count = k - first + 1;
      const variance = squares / count - (sum / count) ** 2;
      // A second at least: the beginning of a recording is none.
      if (times[k] - times[0] >= 1 && variance > largest) [largest, start] = [variance, times[first]];
    }
  }
  return start;
}
