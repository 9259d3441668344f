// The rig: its file, and what it can do.

import { element } from "../shared/dom.js";
import { DEGREES } from "../shared/format.js";
import { asComment, written } from "./parameter-file.js";

/** Text of the rig file; `of(name)` is a parameter's value. */
export function rigFile({ heading, rig_name: name, actuator_diameter: diameter }, of) {
  const real = (value) => written({ kind: "real" }, value);
  const axes = (item) => `[${["x", "y", "z"].map((axis) => real(of(item(axis)))).join(", ")}]`;
  const joints = (where) => [1, 2, 3, 4, 5, 6].map((leg) => `  ${axes((axis) => `rig.${where}[${leg}].${axis}`)},`).join("\n");
  const lines = (prefix, names) => names.map((one) => `${one} = ${real(of(`${prefix}.${one}`))}`);
  const arm = of("crank.arm");
  const cranks = () => [
    "[crank]", ...lines("crank", ["arm", "rod"]),
    `headingDegrees = [${[1, 2, 3, 4, 5, 6].map((crank) => real(of(`crank.heading[${crank}]`) * DEGREES)).join(", ")}]`,
    ...["minAngle", "maxAngle"].map((end) => `${end}Degrees = ${real(of(`crank.${end}`) * DEGREES)}`), ...lines("crank", ["leastTransmission"]),
    ...["velocityLimit", "accelerationLimit"].map((limit) => `${limit} = ${real(of(`actuator.${limit}`) / arm)}`),
  ];
  const legs = () => ["[actuator]", ...lines("actuator", ["minLength", "maxLength", "velocityLimit", "accelerationLimit"])];
  return [
    `# ${asComment(heading)}`, `name = ${JSON.stringify(asComment(`${name}, changed`))}`, ...lines("rig", ["neutralHeight"]),
    "", "[base]", "joints = [", joints("base"), "]",
    "", "[platform]", "joints = [", joints("platform"), "]",
    "", ...(arm > 0 ? cranks() : legs()),
    ...(diameter === null ? [] : [`diameter = ${real(diameter)}`]),
    "", "[head]", ...lines("head", ["height", "torsoLength"]),
    "", "[safety]", ...["positionLimit", "velocityLimit", "accelerationLimit"].map((limit) => `${limit} = ${axes((axis) => `safety.${axis}.${limit}`)}`),
    "",
  ].join("\n");
}

/** The verdict on a rig: reach, speed and acceleration of each axis, and sentences. */
export class RigVerdict {
  constructor() {
    this.state = element("p", { class: "summary", role: "status" });
    this.details = element("div", { id: "verdict" });
  }

  show({ reason, is_sound: isSound, heads, rows, texts }) {
    this.state.classList.toggle("unsound", !isSound);
    this.state.classList.toggle("refused", Boolean(reason));
    this.state.textContent = reason ? `This rig cannot be used: ${reason}` : isSound ? "The rig is sound." : "The rig is not sound.";
    if (reason) {
      this.details.replaceChildren();
      return;
    }
    const cells = (kind, row) => row.map((text, i) => element(i ? kind : "th", { scope: kind === "th" ? "col" : "row", class: i ? "number" : "" }, [text]));
    const head = element("thead", {}, [element("tr", {}, cells("th", heads))]);
    const body = element("tbody", {}, rows.map((row) => element("tr", {}, cells("td", row))));
    this.details.replaceChildren(element("div", { class: "reach" }, [element("table", {}, [head, body])]), ...texts.map((text) => element("p", { class: "summary" }, [text])));
  }
}
