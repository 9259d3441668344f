// The panel with the parameters: each change simulates the recording again and redraws the page.

const BY_HAND = "by hand";
/** Most parameters that a search shows. */
const MOST_FOUND = 12;

/** A value as a parameter file has it. */
function written({ kind, items }, value) {
  if (kind === "enumeration") return `"${items[value - 1]}"`;
  if (kind === "boolean") return String(value !== 0);
  const text = String(value);
  return kind === "real" && /^-?\d+$/.test(text) ? `${text}.0` : text;
}

/** Text of the parameter file: what differs from the rig with default parameters. */
function parameterFile({ parameters, heading }, values) {
  const lines = parameters.flatMap((parameter, slot) => {
    if (values[slot] === parameter.base) return [];
    const unit = parameter.unit ? ` [${parameter.unit}]` : "";
    return [`\n# ${parameter.text}${unit}\n"${parameter.name}" = ${written(parameter, values[slot])}\n`];
  });
  return `# ${heading.replace(/[\u0000-\u001f\u007f]/g, " ")}\n${lines.join("")}`;
}

class Tuning {
  /** `show(run)` shows a simulated run; `choose(original)` chooses between it and the original. */
  constructor(box, simulator, { show: showRun, choose }) {
    Object.assign(this, { box, simulator, showRun, choose });
    this.parameters = simulator.data.parameters;
    this.slots = new Map(this.parameters.map(({ name }, slot) => [name, slot]));
    this.values = this.parameters.map(({ start }) => start);
    this.settled = [...this.values];
    this.history = [];
    this.controls = new Map();
    this.isBusy = false;
    this.build();
  }

  get strategy() {
    const slot = this.slots.get("strategy");
    return this.parameters[slot].items[this.values[slot] - 1];
  }

  build() {
    const button = (text, title, act) => {
      const made = element("button", { type: "button", title }, [text]);
      made.addEventListener("click", act);
      return made;
    };
    this.undoButton = button("Undo", "Take the last change back (control and Z)", () => this.undo());
    this.resetButton = button("Start values", "Set every parameter to its start", () => this.change(this.parameters.map(({ start }) => start)));
    this.compareButton = button("Show the original", "Show the original or the changed one", () => this.compare());
    this.saveButton = button("Save parameters", `Save as ${this.simulator.data.file}`, () => this.save());
    this.copyButton = button("Copy command", this.command(), () => this.copy());
    this.message = element("p", { class: "summary", role: "status" });
    this.groups = element("div");
    this.search = element("input", { type: "search", id: "search", placeholder: "name or description" });
    this.found = element("div");
    this.search.addEventListener("input", () => this.showFound());
    const tools = element("div", { class: "tools" }, [this.undoButton, this.resetButton, this.compareButton, this.saveButton, this.copyButton]);
    const search = element("p", { class: "search" }, [element("label", { for: "search" }, ["Find another parameter"]), " ", this.search]);
    this.box.append(element("summary", {}, ["Change parameters"]), element("div", { class: "panel" }, [tools, this.message, search, this.found, this.groups]));
    this.box.addEventListener("keydown", (event) => {
      if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && event.target !== this.search) {
        event.preventDefault();
        this.undo();
      }
    });
    this.box.addEventListener("toggle", () => {
      document.body.classList.toggle("tuning", this.box.open);
      // On a narrow screen the panel stands over the page, which then shows its curves.
      if (this.box.open && getComputedStyle(this.box).position === "fixed") document.querySelector("#charts .chart")?.scrollIntoView();
    });
    this.showChoice(null);
    this.say(`Every change simulates ${this.subject} again, in this page.`);
    this.showControls();
    this.box.hidden = false;
  }

  /** What is simulated. */
  get subject() {
    const { samples, step } = this.simulator.data;
    const [part, whole] = [this.simulator.samples, samples].map((count) => fixed((count - 1) * step, 1));
    return part === whole ? "the recording" : `the first ${part} of ${whole} s (curves and measures are of this part)`;
  }

  say(text) {
    this.message.textContent = text;
  }

  /** True for parameters that have no effect now: those of other strategies, and of orders that are not used. */
  isIdle(name) {
    const [first] = name.split(".");
    if (this.parameters[this.slots.get("strategy")].items.includes(first)) return first !== this.strategy;
    if (!/^(splitter|angular)\..*\.omega2$/.test(name)) return false;
    return this.values[this.slots.get(`${first}.order`)] === 2;
  }

  control(slot) {
    const parameter = this.parameters[slot];
    if (!this.controls.has(slot)) {
      const changed = (value) => this.move(slot, value);
      this.controls.set(slot, new ParameterControl(parameter, this.values[slot], changed, () => this.settle()));
    }
    return this.controls.get(slot).element;
  }

  /** Shows the parameters that have an effect. Controls that stay keep the focus. */
  showControls() {
    const effective = this.parameters.map(({ name }) => Number(this.isIdle(name))).join("");
    if (effective !== this.effective) this.buildControls();
    this.effective = effective;
    this.showState();
  }

  buildControls() {
    const headings = new Map([["Strategy", []], ["Scales", []], ["Break frequencies", []], ["Tilt limits", []]]);
    this.parameters.forEach(({ name, group }, slot) => {
      if (!group || this.isIdle(name)) return;
      if (!headings.has(group)) headings.set(group, []);
      headings.get(group).push(this.control(slot));
    });
    const focused = document.activeElement;
    const parts = [...headings].filter(([, rows]) => rows.length > 0);
    this.groups.replaceChildren(...parts.flatMap(([heading, rows]) => [element("h3", {}, [heading]), ...rows]));
    this.showFound();
    if (this.box.contains(focused)) focused.focus();
  }

  showFound() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = ({ name, text, is_free: isFree, group }) => isFree && (!group || this.isIdle(name))
      && words.every((word) => `${name} ${text}`.toLowerCase().includes(word));
    const slots = words.length === 0 ? [] : [...this.parameters.keys()].filter((slot) => fits(this.parameters[slot]));
    const more = slots.length - MOST_FOUND;
    const note = words.length === 0 ? "" : slots.length === 0 ? "No other parameter has this in its name or description." : more > 0 ? `${more} more` : "";
    this.found.replaceChildren(...slots.slice(0, MOST_FOUND).map((slot) => this.control(slot)), element("p", { class: "summary" }, [note]));
  }

  showState() {
    for (const [slot, control] of this.controls) control.show(this.values[slot]);
    const isStart = this.values.every((value, slot) => value === this.parameters[slot].start);
    this.undoButton.disabled = this.history.length === 0;
    this.resetButton.disabled = isStart;
  }

  /** A value while its control moves. */
  move(slot, value) {
    if (this.parameters[slot].name === "strategy") {
      this.values = withStrategy(this.simulator.data, this.values, value);
    } else {
      this.values[slot] = value;
      this.controls.get(slot).show(value);
    }
    this.simulate();
  }

  /** Ends a change: what undo goes back from. */
  settle() {
    if (this.values.every((value, slot) => value === this.settled[slot])) return;
    this.history.push(this.settled);
    this.settled = [...this.values];
    this.showControls();
  }

  change(values) {
    this.values = [...values];
    this.settle();
    this.simulate();
  }

  undo() {
    if (this.history.length === 0) return;
    this.values = this.history.pop();
    this.settled = [...this.values];
    this.showControls();
    this.simulate();
  }

  /** Simulates with the values as they are; those that come meanwhile are next. */
  async simulate() {
    this.isStale = true;
    if (this.isBusy) return;
    this.isBusy = true;
    while (this.isStale) {
      this.isStale = false;
      const begin = performance.now();
      const run = await this.simulator.run(this.values, BY_HAND);
      if (run.reason) {
        this.say(`These parameters cannot be used: ${run.reason}`);
      } else {
        this.isChanged = true;
        this.showRun(run);
        this.say(`Simulated ${this.subject} in ${fixed(performance.now() - begin, 0)} ms.`);
      }
    }
    this.isBusy = false;
  }

  compare() {
    this.choose(this.compareButton.getAttribute("aria-pressed") !== "true");
  }

  /** Says whether the run that is shown is another than the changed one. */
  showChoice(run) {
    this.compareButton.disabled = !this.isChanged;
    this.compareButton.setAttribute("aria-pressed", String(Boolean(this.isChanged) && run !== report.runs.at(-1)));
  }

  command() {
    const { command, file } = this.simulator.data;
    const plain = /^[\w./-]+$/.test(file) ? file : `'${file.replaceAll("'", "'\\''")}'`;
    return `${command} ${plain}`;
  }

  save() {
    const link = element("a", { download: this.simulator.data.file });
    link.href = URL.createObjectURL(new Blob([parameterFile(this.simulator.data, this.values)], { type: "application/toml" }));
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  async copy() {
    const text = this.command();
    try {
      await navigator.clipboard.writeText(text);
      this.say(`Copied: ${text}`);
    } catch {
      this.say(text);
    }
  }
}
