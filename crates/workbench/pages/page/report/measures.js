// The measures, channel by channel: the runs side by side, and each measure's definition and source below it all.

import { significant } from "../shared/format.js";
import { element } from "../shared/dom.js";

export const cellText = (value) => (value == null ? "\u2013" : significant(value, 3));

/** The index of the best of some runs' values of a measure; -1 where none is better than another. */
function best(values, better) {
  const numbers = values.map((value) => value ?? NaN);
  if (better === "neither" || numbers.length < 2 || numbers.some(Number.isNaN)) return -1;
  const winner = better === "less" ? Math.min(...numbers) : Math.max(...numbers);
  return new Set(numbers.map((number) => significant(number, 3))).size > 1 ? numbers.indexOf(winner) : -1;
}

/** The groups in the order in which they first appear: { name, measures }, each measure with its value in every run. */
function gathered(runs) {
  const groups = new Map();
  for (const run of runs) {
    for (const measure of run.measures) {
      if (!groups.has(measure.group)) groups.set(measure.group, new Map());
      const measures = groups.get(measure.group);
      if (!measures.has(measure.name)) measures.set(measure.name, { ...measure, values: runs.map(() => undefined) });
      measures.get(measure.name).values[run.index] = measure.value;
    }
  }
  return [...groups].map(([name, measures]) => ({ name, measures: [...measures.values()] }));
}

/** The channels: a group with what is sensed of it. */
function byChannel(groups) {
  const known = new Map();
  for (const group of groups) {
    const [, sensed] = /^Sensed (.*)/.exec(group.name) ?? [];
    const name = sensed ? sensed[0].toUpperCase() + sensed.slice(1) : group.name;
    if (!known.has(name)) known.set(name, []);
    known.get(name).push({ name: group.name, part: sensed ? "sensed: " : "", measures: group.measures });
  }
  return [...known].map(([name, parts]) => ({ name, groups: parts }));
}

/** A block: a row for each measure of a channel, a column for each run. */
function channelBlock({ name, groups }, runs) {
  const several = runs.length > 1;
  const heads = runs.map((run) => element("th", { scope: "col", class: "run number" }, [runMark(run), run.name]));
  const head = element("thead", {}, [element("tr", {}, [element("td"), ...heads])]);
  const rows = groups.flatMap(({ name: group, part, measures }) => measures.map(({ name: measure, unit: inUnit, definition, values, better }) => {
    const shownUnit = element("span", { class: "unit" }, [inUnit]);
    const cells = runs.map((run, i) => {
      const of = best(values, better) === i ? "number best" : "number";
      return element("td", { class: of }, [cellText(values[i])]);
    });
    const heading = element("th", { scope: "row", title: definition }, [`${measure.startsWith("sensed") ? "" : part}${measure} `, shownUnit]);
    const row = element("tr", {}, [heading, ...cells]);
    Object.assign(row.dataset, { group, measure });
    return row;
  }));
  const table = element("table", {}, [...(several ? [head] : []), element("tbody", {}, rows)]);
  return element("div", { class: "channel" }, [element("h3", {}, [name]), table]);
}

const runMark = (run) => element("span", { class: "mark", style: `background: var(${run.colour})` });

/** Every definition once, with its source and what it is the definition of. */
export function definitions(groups) {
  const known = new Map();
  for (const { name: group, measures } of groups) {
    for (const { name, definition, source } of measures) {
      const key = JSON.stringify([name, definition, source]);
      if (!known.has(key)) known.set(key, { name, definition, source, of: [] });
      known.get(key).of.push(group);
    }
  }
  const rows = [...known.values()].map(({ name, definition, source, of }) => element("tr", {}, [
    element("th", { scope: "row" }, [name]),
    ...[of.join(", "), definition, source].map((text) => element("td", { class: "definition" }, [text])),
  ]));
  const heads = ["measure", "of", "definition", "source"].map((text) => element("th", { scope: "col" }, [text]));
  const table = element("table", {}, [element("thead", {}, [element("tr", {}, heads)]), element("tbody", {}, rows)]);
  return element("details", {}, [element("summary", {}, ["Definitions and sources"]), table]);
}

export function showMeasures(box, runs) {
  const groups = gathered(runs);
  if (groups.length === 0) return;
  const wasOpen = box.querySelector("details")?.open;
  const blocks = byChannel(groups).map((channel) => channelBlock(channel, runs));
  box.replaceChildren(element("h2", {}, ["Measures"]), element("div", { class: "channels" }, blocks));
  if (runs.length > 1) box.append(element("p", { class: "summary" }, ["Bold: the better value."]));
  box.append(definitions(groups), printChoice());
  box.querySelector("details").open = Boolean(wasOpen);
}

/** The switch that prints the definitions, too; it stays as it is when the measures change. */
export const printBox = element("input", { type: "checkbox", id: "print-definitions" });
const printChoice = () => element("label", { class: "print-choice" }, [printBox, " print with the definitions"]);
