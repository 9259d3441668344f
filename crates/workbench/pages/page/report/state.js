// The state of a run at one time.

import { rotation } from "../shared/vector.js";
import { indexAt, valueAt } from "./data.js";

/** Everything about a run at one time. */
export function stateAt(run, time) {
  const at = (values) => valueAt(run.times, values, time);
  const i = indexAt(run.times, time);
  const [roll, pitch, yaw] = run.orientation.map(at);
  return {
    position: run.position.map(at),
    rotation: rotation(roll, pitch, yaw),
    lean: run.lean ? at(run.lean) : 0,
    legs: run.legs.map(at),
    desired: run.desired.specific_force.map(at),
    felt: run.felt.specific_force.map(at),
    limited: { tilt: run.limited.tilt[i], soft: run.limited.soft[i], safety: run.limited.safety[i], actuator: run.limited.actuator[i] },
  };
}
