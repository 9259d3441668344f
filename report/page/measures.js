// The table of measures: the runs side by side, each measure with its definition and source.

function cellText(value) {
  return typeof value === "number" ? significant(value, 3) : value ?? "\u2013";
}

/** The index of the best of some runs' values of a measure; -1 where none is better than another. */
function best(values, better) {
  const numbers = values.map((value) => (typeof value === "number" ? value : NaN));
  if (better === "neither" || numbers.length < 2 || numbers.some(Number.isNaN)) return -1;
  const winner = better === "less" ? Math.min(...numbers) : Math.max(...numbers);
  return new Set(numbers.map((number) => significant(number, 3))).size > 1 ? numbers.indexOf(winner) : -1;
}

/** Rows of all runs by group and name, in the order in which they first appear. */
function gathered(runs) {
  const groups = new Map();
  for (const run of runs) {
    for (const measure of run.measures) {
      if (!groups.has(measure.group)) groups.set(measure.group, new Map());
      const rows = groups.get(measure.group);
      if (!rows.has(measure.name)) rows.set(measure.name, { ...measure, values: runs.map(() => undefined) });
      rows.get(measure.name).values[run.index] = measure.value;
    }
  }
  return groups;
}

function measureRow({ name, unit: inUnit, better, definition, source, values }) {
  const winner = best(values, better);
  const cells = values.map((value, i) => {
    const of = i === winner ? "number best" : "number";
    return element("td", { class: of }, [cellText(value)]);
  });
  return element("tr", {}, [
    element("th", { scope: "row" }, [name]), ...cells,
    element("td", { class: "unit" }, [inUnit]),
    element("td", { class: "definition" }, [definition]),
    element("td", { class: "definition" }, [source]),
  ]);
}

function showMeasures(box, runs) {
  const groups = gathered(runs);
  if (groups.size === 0) return;
  const heads = ["", ...runs.map((run) => (runs.length > 1 ? run.name : "")), "", "definition", "source"];
  const isNumber = (column) => column >= 1 && column <= runs.length;
  const cells = heads.map((text, i) => element("th", { scope: "col", class: isNumber(i) ? "number" : "" }, [text]));
  const head = element("tr", {}, cells);
  const body = [];
  for (const [group, rows] of groups) {
    body.push(element("tr", { class: "group" }, [element("th", { colspan: String(heads.length), scope: "colgroup" }, [group])]));
    body.push(...[...rows.values()].map(measureRow));
  }
  const table = element("table", {}, [element("thead", {}, [head]), element("tbody", {}, body)]);
  box.append(element("h2", {}, ["Measures"]), element("div", { class: "wide" }, [table]));
  if (runs.length > 1) box.append(element("p", { class: "summary" }, ["Bold: the better value."]));
}
