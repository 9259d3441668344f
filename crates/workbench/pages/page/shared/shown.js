// What pages with a running platform show beside its drawing: lamps, colours, the state as the drawing takes it.

import { byId, element } from "./dom.js";
import { fixed } from "./format.js";
import { colour } from "./palette.js";
import { rotation } from "./vector.js";

const LAMPS = [
  ["tilt", "Tilt", "Tilt coordination lags behind its target because of its rate, acceleration or angle limit."],
  ["soft", "Soft limits", "The soft limits change the motion ahead of a limit."],
  ["safety", "Safety", "A safety unit limits position, velocity or acceleration of the platform."],
  ["stroke", "Stroke", "A leg is within 5 % of its stroke from an end."],
  ["leg_speed", "Leg speed", "A leg has more than 90 % of its largest speed."],
  ["leg_acceleration", "Leg accel.", "A leg has more than 90 % of its largest acceleration."],
];
/** Time for which a lamp stays lit, so that it can be seen [s]. */
const GLOW = 0.4;
export const STRIP = { desired: "--desired", felt: "--run-1", muted: "--muted", axis: "--axis", rule: "--rule" };

export const resolved = (names) => Object.fromEntries(Object.entries(names).map(([key, name]) => [key, colour(name)]));

/** Lamps that stay lit for a while. */
export class Lamps {
  constructor(list) {
    this.lit = new Map();
    this.lamps = LAMPS.map(([name, label, help]) => {
      const lamp = element("li", { title: help }, [label]);
      list.append(lamp);
      return [name, lamp];
    });
    this.scale = element("li", { title: "The automatic scale makes force and rates smaller, so that they are felt the right way round." });
    list.append(this.scale);
  }

  show(view, time) {
    const scale = `Scale ${fixed(view.scale, 2)}`;
    if (this.scale.textContent !== scale) this.scale.textContent = scale;
    for (const [name, lamp] of this.lamps) {
      if (view[name]) this.lit.set(name, time + GLOW);
      lamp.classList.toggle("lit", time < (this.lit.get(name) ?? 0));
    }
  }
}

export function addLegend(list) {
  for (const [label, paint] of [["desired", "--desired"], ["felt", "--run-1"]]) {
    const mark = element("span", { class: "mark", style: `background: var(${paint})` });
    list.append(element("li", {}, [mark, label]));
  }
}

export function setText(id, text) {
  const box = byId(id);
  if (box.textContent !== text) box.textContent = text;
}

/** The view as the drawing of the machine takes it. */
export function machineState(view) {
  const { platform_x: x, platform_y: y, platform_z: z } = view;
  return {
    position: [x, y, z],
    rotation: rotation(view.platform_roll, view.platform_pitch, view.platform_yaw),
    lean: view.lean,
    legs: [1, 2, 3, 4, 5, 6].map((leg) => view[`leg${leg}`]),
    parked: view.parked ?? false,
    desired: [view.desired_x, view.desired_y, view.desired_z],
    felt: [view.felt_x, view.felt_y, view.felt_z],
  };
}

/** Calls `frame(seconds since the last, time)` for every picture of the screen, as long as it returns true. */
export function animate(frame) {
  let before = performance.now();
  function tick(at) {
    const seconds = Math.max(0, at - before) / 1000;
    before = at;
    if (frame(seconds, at)) requestAnimationFrame(tick);
  }
  requestAnimationFrame(tick);
  byId("alarm").hidden = true;
}
