// Names, colours and units of what charts show by axis.

import { DEGREES } from "../shared/format.js";

export const AXES = [["Surge", "x"], ["Sway", "y"], ["Heave", "z"]];
export const TURNS = ["Roll", "Pitch", "Yaw"];
export const THREE = ["--axis-x", "--axis-y", "--axis-z"];
export const LEGS = ["--leg-1", "--leg-2", "--leg-3", "--leg-4", "--leg-5", "--leg-6"];

/** A loop, because `map` takes six times as long, and all curves wait for it while a slider moves. */
export function inDegrees(values) {
  const made = new Float32Array(values.length);
  for (let k = 0; k < made.length; k += 1) made[k] = values[k] * DEGREES;
  return made;
}

/** How the positions of a rig's actuators are shown: lengths of legs, or angles of arms. */
export const actuatorsOf = ({ cranks }) => (cranks
  ? { name: "Arm", heading: "Cranks", title: "Angle", unit: "\u00b0", digits: 1, shown: (arcs) => inDegrees(arcs).map((arc) => arc / cranks.arm) }
  : { name: "Leg", heading: "Legs", title: "Length", unit: "m", digits: 3, shown: (lengths) => lengths });
