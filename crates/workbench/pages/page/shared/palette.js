// Colours: those of the style sheet, so that they follow the reader's choice of light or dark.

const style = getComputedStyle(document.documentElement);

export const colour = (name) => style.getPropertyValue(name).trim();

/** Red, green and blue of a colour that is written #rrggbb. */
export const channels = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

export const rgb = (parts) => `rgb(${parts.map((part) => Math.round(part)).join(", ")})`;

/** So much of the second colour in the first. */
export const mixed = (first, second, fraction) => first.map((part, i) => part + fraction * (second[i] - part));

/** Colours of a leg by how much of its stroke is left to the nearer end: 1 in the middle, 0 at an end. */
const STROKE_COLOURS = [[0, "--leg-end"], [0.2, "--leg-near"], [0.4, "--leg-some"], [0.6, "--leg-easy"]];

export function strokeColour(length, [shortest, longest]) {
  const left = Math.min(length - shortest, longest - length) / (0.5 * (longest - shortest));
  const above = STROKE_COLOURS.findIndex(([from]) => left < from);
  if (above === 0) return channels(colour("--leg-end"));
  if (above < 0) return channels(colour("--leg-easy"));
  const [[low, one], [high, other]] = [STROKE_COLOURS[above - 1], STROKE_COLOURS[above]];
  return mixed(channels(colour(one)), channels(colour(other)), (left - low) / (high - low));
}

/** Dashes that tell curves from each other without colour: in drawing order, the first is a whole line. */
export const DASHES = [[], [7, 3], [2, 2.5], [9, 3, 2, 3], [5, 2, 1, 2, 1, 2], [12, 4]];
