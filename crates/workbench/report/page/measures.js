// The table of measures: the runs one below the other, and each measure's definition and source below it all.

const cellText = (value) => (value == null ? "\u2013" : significant(value, 3));

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

/** Groups that hold the same measures, which stand in one table. */
function alike(groups) {
  const tables = new Map();
  for (const group of groups) {
    const columns = JSON.stringify(group.measures.map((measure) => [measure.name, measure.unit]));
    if (!tables.has(columns)) tables.set(columns, []);
    tables.get(columns).push(group);
  }
  return [...tables.values()];
}

/** A table: a column for each measure, a row for each group and run. */
function measureTable(groups, runs) {
  const [{ measures: columns }] = groups;
  const several = runs.length > 1;
  const heads = columns.map(({ name, unit: inUnit, definition }) => {
    const shownUnit = element("span", { class: "unit" }, [inUnit]);
    return element("th", { scope: "col", class: "number", title: definition }, [name, " ", shownUnit]);
  });
  const head = element("tr", {}, [element("th"), ...(several ? [element("th")] : []), ...heads]);
  const rows = groups.flatMap((group) => runs.map((run, i) => {
    const name = element("th", { scope: "row" }, [i === 0 ? group.name : ""]);
    const ofRun = several ? [element("td", { class: "run" }, [runMark(run), run.name])] : [];
    const cells = group.measures.map(({ values, better }) => {
      const of = best(values, better) === i ? "number best" : "number";
      return element("td", { class: of }, [cellText(values[i])]);
    });
    return element("tr", { class: i === 0 ? "group" : "" }, [name, ...ofRun, ...cells]);
  }));
  const table = element("table", {}, [element("thead", {}, [head]), element("tbody", {}, rows)]);
  return element("div", { class: "wide" }, [table]);
}

const runMark = (run) => element("span", { class: "mark", style: `background: var(${run.colour})` });

/** Every definition once, with its source and what it is the definition of. */
function definitions(groups) {
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

function showMeasures(box, runs) {
  const groups = gathered(runs);
  if (groups.length === 0) return;
  const wasOpen = box.querySelector("details")?.open;
  box.replaceChildren(element("h2", {}, ["Measures"]), ...alike(groups).map((table) => measureTable(table, runs)));
  if (runs.length > 1) box.append(element("p", { class: "summary" }, ["Bold: the better value."]));
  box.append(definitions(groups));
  box.querySelector("details").open = Boolean(wasOpen);
}
