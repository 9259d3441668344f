// Parameters in plain words, and the words by which they are found.

const ALONG = { x: "surge", y: "sway", z: "heave" };
const ABOUT = { x: "roll", y: "pitch", z: "yaw" };
/** What a splitter does on an axis; heave has no tilt. */
const split = (axis) => axis === "z" ? "Return of heave to neutral" : `Hand-over of ${ALONG[axis]} from travel to tilt`;

/** What each name means; `[a-z]` of a pattern are its captures. The last text has further words for the search. */
const PLAIN = [
  [/^strategy$/, () => "Strategy", "kind of cueing"],
  [/^scale\.automatic$/, () => "Automatic size", "strong weak"],
  [/^scale\.specificForce\.(.)$/, (axis) => `Size of ${ALONG[axis]}`, "strong weak stronger weaker gain"],
  [/^scale\.angularVelocity\.(.)$/, (axis) => `Size of the ${ABOUT[axis]} rate`, "strong weak stronger weaker gain"],
  [/^splitter\.(.)\.omega1$/, (axis) => `${split(axis)}, first pair`, "slow fast high-pass travel stroke"],
  [/^splitter\.(.)\.omega2$/, (axis) => `${split(axis)}, second part`, "slow fast high-pass travel stroke"],
  [/^splitter\.(.)\.zeta[12]$/, (axis) => `Calm of ${axis === "z" ? "the return" : "the hand-over"} of ${ALONG[axis]}`, "smooth gentle swing overshoot"],
  [/^splitter\.(.)\.lowPass/, (axis) => `Slow part of ${ALONG[axis]}`, "smooth gentle"],
  [/^angular\.(\w+)\.omega([12])$/, (turn, part) => `Return of ${turn} to level, ${part === "1" ? "first pair" : "second part"}`, "slow fast high-pass"],
  [/^angular\.(\w+)\.zeta[12]$/, (turn) => `Calm of the return of ${turn} to level`, "smooth gentle swing overshoot"],
  [/^limit\.specificForce\.(.)$/, (axis) => `Largest cue of ${ALONG[axis]}`, "smooth gentle strong peak"],
  [/^limit\.angularVelocity\.(.)$/, (axis) => `Largest cue of the ${ABOUT[axis]} rate`, "smooth gentle strong peak"],
  [/^input\.cutoff$/, () => "Smoothing of the vehicle's motion", "smooth gentle vibration noise shake rough"],
  [/^input\.rateCutoff$/, () => "Smoothing of the vehicle's rates", "smooth gentle vibration noise shake rough"],
  [/^input\.reconstruction$/, () => "Motion between two samples", "smooth steps"],
  [/^tilt\.rateLimit$/, () => "Fastest tilt", "smooth gentle slow"],
  [/^tilt\.accelerationLimit$/, () => "Hardest start of a tilt", "smooth gentle jerk jolt"],
  [/^tilt\.angleLimit$/, () => "Largest tilt", "lasting force"],
  [/^\w+\.weightPosition$/, () => "Price of travel", "stroke distance"],
  [/^\w+\.weightVelocity$/, () => "Price of fast travel", "smooth gentle speed"],
  [/^\w+\.weightTiltRate$/, () => "Price of fast tilt", "smooth gentle rotation"],
  [/^\w+\.weightTiltAcceleration$/, () => "Price of jerky tilt", "smooth gentle jerk jolt"],
  [/^\w+\.slowPole$/, () => "Expected decay of slow force", ""],
  [/^\w+\.fastPole$/, () => "Expected decay of fast force", ""],
  [/^\w+\.splitTime$/, () => "Border between slow and fast force", ""],
  [/^robust\.attenuation$/, () => "Care for the worst case", ""],
  [/^robust\.fastDisturbance$/, () => "Weight of sudden force", ""],
  [/^predictive\.legMargin$/, () => "Reserve of the legs in a plan", "smooth gentle stroke"],
  [/^predictive\.forecast$/, () => "Forecast of the force", ""],
  [/^adaptive\.omega$/, () => "Hand-over from travel to tilt", "slow fast high-pass"],
  [/^adaptive\.zeta$/, () => "Calm of the hand-over", "smooth gentle swing overshoot"],
  [/^adaptive\.gain(.)$/, (which) => `Speed of adaptation of ${which === "1" ? "travel" : "tilt"}`, "fast slow"],
  [/^adaptive\.nominal(.)$/, (which) => `Usual share of ${which === "1" ? "travel" : "tilt"}`, "gain"],
  [/^adaptive\.pull(.)$/, (which) => `Pull to the usual share of ${which === "1" ? "travel" : "tilt"}`, "gain"],
  [/^softLimit\.pace$/, () => "Gentleness before a limit", "smooth gentle soft brake slow"],
  [/^softLimit\.margin$/, () => "Reserve before a limit", "smooth gentle soft stroke"],
  [/^automaticScale\.error$/, () => "Error that the automatic size permits", "strong weak"],
  [/^automaticScale\.memory$/, () => "Memory of the automatic size", "strong weak"],
  [/^automaticScale\.fallTime$/, () => "Time in which the automatic size falls", "smooth gentle strong weak"],
  [/^automaticScale\.start$/, () => "Automatic size at the ride's beginning", "strong weak"],
  [/^automaticScale\.riseTime$/, () => "Time in which the automatic size rises", "smooth gentle strong weak"],
  [/^preaction$/, () => "Acting ahead of a stop", "brake"],
  [/^safety\.(.)\.positionLimit$/, (axis) => `Longest travel of ${ALONG[axis]}`, "stroke"],
  [/^safety\.(.)\.velocityLimit$/, (axis) => `Fastest travel of ${ALONG[axis]}`, "speed"],
  [/^safety\.(.)\.accelerationLimit$/, (axis) => `Hardest acceleration of ${ALONG[axis]}`, "smooth gentle brake"],
  [/^rig\.neutralHeight$/, () => "Height at neutral", ""],
  [/^actuator\.minLength$/, () => "Shortest leg", "stroke"],
  [/^actuator\.maxLength$/, () => "Longest leg", "stroke"],
  [/^actuator\.velocityLimit$/, () => "Fastest leg", "speed"],
  [/^actuator\.accelerationLimit$/, () => "Hardest acceleration of a leg", ""],
  [/^head\.height$/, () => "Height of the head", ""],
  [/^head\.torsoLength$/, () => "Length of the torso", ""],
];

/** A parameter's meaning in plain words; nothing where its description says it as briefly. */
export function plainWords({ name }) {
  for (const [pattern, plain] of PLAIN) {
    const found = pattern.exec(name);
    if (found) return plain(...found.slice(1));
  }
  return "";
}

/** All by which a parameter is found, in lower case. */
export function searched(parameter) {
  const words = PLAIN.find(([pattern]) => pattern.test(parameter.name))?.[2] ?? "";
  return [parameter.name, plainWords(parameter), parameter.text, words].join(" ").toLowerCase();
}

/** The items and values of parameters by name, as they are chosen in `values`. */
export const chosen = (parameters, values) => new Map(parameters.map(({ name, items }, slot) => [name, { items, value: items[values[slot] - 1] ?? values[slot] }]));

/** True for parameters of another strategy than the chosen one: their names begin with it. */
function isElsewhere({ name }, strategy) {
  const [first] = name.split(".");
  return strategy.items.includes(first) && first !== strategy.value;
}

/** The slots of the parameters that the strategy uses, by their group. */
export function slotsByGroup(parameters, strategy, groups = new Map()) {
  parameters.forEach((parameter, slot) => {
    const { group } = parameter;
    if (group && !isElsewhere(parameter, strategy)) groups.set(group, [...groups.get(group) ?? [], slot]);
  });
  return groups;
}

/** Why a parameter has no effect now, given what is chosen; nothing if it has one. */
export function idleReason({ used_if: conditions }, given) {
  const unmet = conditions.find(([other, values]) => !values.includes(String(given.get(other).value)));
  if (!unmet) return "";
  const [other, values] = unmet;
  const { items, value } = given.get(other);
  if (other === "strategy") return `no effect with strategy ${value}`;
  return items.length > 0 ? `no effect unless ${other} is ${values.join(" or ")}` : `no effect while ${other} is ${value}`;
}
