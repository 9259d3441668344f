// The panel with the parameters: each change simulates the recording again and redraws the page.

import { fixed } from "../shared/format.js";
import { element, saveAs } from "../shared/dom.js";
import { chosen, slotsByGroup, idleReason, plainWords, searched } from "../shared/words.js";
import { ParameterControl } from "../shared/parameter.js";
import { report } from "./data.js";
import { panelButton, Variants } from "./variants.js";
import { parameterFile } from "./parameter-file.js";
import { rigFile, RigVerdict } from "./rig.js";

/** Most parameters that a search shows. */
const MOST_FOUND = 12;
/** Time for which changes may follow each other so closely that none is simulated to its end [ms]. */
const UNFINISHED = 300;

/** Parameters that a fitting scale multiplies. */
const SCALED = /^scale\.(specificForce\.[xy]|angularVelocity\.[xyz])$/;

export class Tuning {
  /** `show(run)` shows a run, and every curve and measure anew; `showCurves(run)` curves that change. */
  constructor(box, simulator, show, showCurves) {
    Object.assign(this, { box, simulator, show, showCurves });
    this.parameters = simulator.data.parameters;
    this.slots = new Map(this.parameters.map(({ name }, slot) => [name, slot]));
    this.values = this.parameters.map(({ start }) => start);
    report.runs[0].values = [...this.values];
    this.settled = [...this.values];
    this.history = [];
    this.future = [];
    this.controls = new Map();
    this.isBusy = false;
    this.byHand = null;
    this.build();
  }

  /** What is chosen now, by name. */
  get chosen() {
    return chosen(this.parameters, this.values);
  }

  get strategy() {
    return this.chosen.get("strategy").value;
  }

  build() {
    this.variants = new Variants(this.show, (text) => this.say(text));
    this.undoButton = panelButton("Undo", "Take the last change back (control and Z)", () => this.undo());
    this.redoButton = panelButton("Redo", "Make the change again (control, shift and Z)", () => this.redo());
    this.resetButton = panelButton("Start values", "Set every parameter to its start", () => this.change(this.parameters.map(({ start }) => start)));
    this.saveButton = panelButton("Save parameters", "Save the shown run's parameters as a file", () => this.save());
    this.copyButton = panelButton("Copy command", "Copy the command that simulates with the saved file", () => this.copy());
    this.saveRigButton = panelButton("Save rig", "Save the shown run's rig as a file for --rig", () => saveAs(this.rigFileName, this.rigFile(), "application/toml"));
    this.verdict = new RigVerdict();
    this.message = element("p", { class: "summary", role: "status" });
    this.groups = element("div");
    this.search = element("input", { type: "search", id: "search", placeholder: "as smooth, gentle, strong" });
    this.found = element("div");
    this.search.addEventListener("input", () => this.showFound());
    const tools = element("div", { class: "tools" }, [this.undoButton, this.redoButton, this.resetButton, this.saveButton, this.copyButton]);
    const search = element("p", { class: "search" }, [element("label", { for: "search" }, ["Find a parameter"]), " ", this.search]);
    this.box.append(element("summary", {}, ["Change parameters"]), element("div", { class: "panel" }, [tools, this.variants.element, this.message, search, this.found, this.groups]));
    this.box.addEventListener("keydown", (event) => {
      const isText = event.target === this.search || event.target === this.variants.name;
      if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || isText) return;
      event.preventDefault();
      if (event.shiftKey) this.redo();
      else this.undo();
    });
    this.box.addEventListener("toggle", () => {
      document.body.classList.toggle("tuning", this.box.open);
      this.work();
      // On a narrow screen the panel stands over the page, which then shows its curves.
      if (this.box.open && getComputedStyle(this.box).position === "fixed") document.querySelector("#charts .chart")?.scrollIntoView();
    });
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

  say(text, isRefused = false) {
    this.message.classList.toggle("refused", isRefused);
    this.message.textContent = text;
  }

  control(slot) {
    const parameter = this.parameters[slot];
    if (!this.controls.has(slot)) {
      const changed = (value) => this.move(slot, value);
      this.controls.set(slot, new ParameterControl(parameter, this.values[slot], changed, () => this.settle()));
    }
    return this.controls.get(slot).element;
  }

  /** Shows the parameters of the strategy. Controls that stay keep the focus. */
  showControls() {
    if (this.strategy !== this.shownStrategy) this.buildControls();
    this.shownStrategy = this.strategy;
    this.showState();
  }

  buildControls() {
    const headings = slotsByGroup(this.parameters, this.chosen.get("strategy"), new Map([["Strategy", []], ["Scales", []]]));
    const focused = document.activeElement;
    const ofRig = headings.get("Rig") ?? [];
    headings.delete("Rig");
    this.sections = [...headings].filter(([, slots]) => slots.length > 0).map(([heading, slots]) => ({ head: element("h3", {}, [heading]), slots }));
    const rows = (slots) => slots.map((slot) => this.control(slot));
    const rig = [element("h3", {}, ["Rig"]), this.verdict.state, ...rows(ofRig), element("div", { class: "tools" }, [this.saveRigButton]), this.verdict.details];
    this.groups.replaceChildren(...this.sections.flatMap(({ head, slots }) => [head, ...rows(slots)]), ...rig);
    this.sections.push({ slots: ofRig });
    this.showFound();
    if (this.box.contains(focused)) focused.focus();
  }

  /** Shows what has all the words of the search: of the groups, and of all other parameters. */
  showFound() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = (slot) => words.every((word) => searched(this.parameters[slot]).includes(word));
    for (const { head, slots } of this.sections) {
      for (const slot of slots) this.control(slot).hidden = !fits(slot);
      if (head) head.hidden = !slots.some(fits);
    }
    const grouped = new Set(this.sections.flatMap(({ slots }) => slots));
    const isOther = (slot) => this.parameters[slot].is_free && !grouped.has(slot) && fits(slot);
    // First those that have an effect, and of these the ones that are called so.
    const isCalled = (slot) => words.every((word) => plainWords(this.parameters[slot]).toLowerCase().includes(word));
    const now = this.chosen;
    const rank = (slot) => 2 * Number(Boolean(idleReason(this.parameters[slot], now))) + Number(!isCalled(slot));
    const others = words.length === 0 ? [] : [...this.parameters.keys()].filter(isOther).sort((a, b) => rank(a) - rank(b));
    const more = others.length - MOST_FOUND;
    const isFound = others.length > 0 || [...grouped].some(fits);
    const note = !isFound ? "No parameter has this in its name or description." : more > 0 ? `${more} more` : "";
    this.found.replaceChildren(...others.slice(0, MOST_FOUND).map((slot) => this.control(slot)), element("p", { class: "summary" }, [note]));
    for (const slot of others) this.control(slot).hidden = false;
    this.showIdle();
  }

  showIdle() {
    const now = this.chosen;
    for (const [slot, control] of this.controls) control.showIdle(idleReason(this.parameters[slot], now));
  }

  /** The fitting scale of the recording; nothing where a parameter differs that is no scale. */
  get fittingScale() {
    const isSame = this.parameters.every(({ name, start }, slot) => SCALED.test(name) || this.values[slot] === start);
    return isSame ? report.runs[0].fitting_scale : undefined;
  }

  showState() {
    const fitting = this.fittingScale;
    for (const [slot, control] of this.controls) {
      const { name, start } = this.parameters[slot];
      control.show(this.values[slot]);
      control.showFitting(fitting !== undefined && SCALED.test(name) ? fitting * start : undefined);
    }
    this.showIdle();
    const isStart = this.values.every((value, slot) => value === this.parameters[slot].start);
    this.undoButton.disabled = this.history.length === 0;
    this.redoButton.disabled = this.future.length === 0;
    this.resetButton.disabled = isStart;
  }

  /** A value while its control moves. */
  move(slot, value) {
    this.values[slot] = value;
    this.controls.get(slot).show(value);
    this.simulate();
  }

  /** Ends a change: what undo goes back from. */
  settle() {
    if (this.values.every((value, slot) => value === this.settled[slot])) return;
    this.history.push(this.settled);
    this.future = [];
    this.settled = [...this.values];
    this.showControls();
  }

  change(values) {
    this.values = [...values];
    this.settle();
    this.simulate();
  }

  undo() {
    this.go(this.history, this.future);
  }

  redo() {
    this.go(this.future, this.history);
  }

  /** Goes to the last of some settled values, and puts the present ones to others. */
  go(from, to) {
    if (from.length === 0) return;
    to.push(this.settled);
    this.values = from.pop();
    this.settled = [...this.values];
    this.showControls();
    this.simulate();
  }

  /** Simulates with the values as they are. A run with other values is given up, unless several have been. */
  simulate() {
    this.isStale = true;
    this.unfinishedSince ??= performance.now();
    if (performance.now() - this.unfinishedSince < UNFINISHED) this.simulator.abandon();
    this.work();
  }

  /** Simulates, and then checks the rig, until both have the values as they are. */
  async work() {
    if (this.isBusy) return;
    this.isBusy = true;
    while (this.isStale || this.rigKey !== this.checkedRig) {
      if (this.isStale) await this.simulateOnce();
      else await this.checkRig();
    }
    this.isBusy = false;
  }

  async simulateOnce() {
    this.isStale = false;
    const begin = performance.now();
    const values = [...this.values];
    const run = await this.simulator.run(values, this.byHand ?? this.variants.shown, (curves) => this.showPart(curves));
    if (run.isAbandoned) return;
    this.unfinishedSince = null;
    if (run.reason) {
      if (this.isPart) this.showByHand(false);
      this.say(`These parameters cannot be used: ${run.reason}`, true);
      return;
    }
    this.byHand = { ...run, values };
    this.showByHand(true);
    // Another run may have been chosen meanwhile; the panel is again that of this one.
    if (!this.isStale && values.some((value, slot) => value !== this.values[slot])) {
      this.values = values;
      this.showControls();
    }
    this.say(`Simulated ${this.subject} in ${fixed(performance.now() - begin, 0)} ms.`);
  }

  /** Shows the curves of a run that is being simulated. */
  showPart(curves) {
    this.isPart = true;
    this.showCurves(this.variants.putByHand(curves));
  }

  /** Shows the last run by hand that was simulated to its end; without one, the run that was shown before. */
  showByHand(isMoving) {
    this.isPart = false;
    this.isShowing = true;
    this.show(this.byHand ? this.variants.putByHand(this.byHand) : this.variants.withoutByHand(), isMoving);
    this.isShowing = false;
  }

  /** The values that the verdict depends on, as one text. */
  get rigKey() {
    return this.values.filter((_, slot) => /^(rig|actuator|safety|head)\./.test(this.parameters[slot].name)).join(" ");
  }

  async checkRig() {
    this.checkedRig = this.rigKey;
    this.verdict.show(await this.simulator.check(this.values));
  }

  /** Takes note of the shown run, and takes its parameters where they are known; not while a slider moves. */
  see(run) {
    this.variants.see(run);
    this.saveButton.disabled = !run.values;
    this.copyButton.disabled = !run.values;
    this.saveRigButton.disabled = !run.values;
    if (this.isShowing || !run.values) return;
    this.values = [...run.values];
    this.showControls();
  }

  /** Name of the shown run's file. */
  get fileName() {
    const { file } = this.simulator.data;
    const { isKept, name } = this.variants.shown;
    return isKept ? file.replace(/\.toml$/, `-${name.replace(/[^\p{L}\p{N}_.-]+/gu, "-")}.toml`) : file;
  }

  command() {
    const file = this.fileName;
    const plain = /^[\w./-]+$/.test(file) ? file : `'${file.replaceAll("'", "'\\''")}'`;
    return `${this.simulator.data.command} ${plain}`;
  }

  get rigFileName() {
    return this.fileName.replace(/\.toml$/, ".rig.toml");
  }

  /** Text of the shown run's rig file. */
  rigFile() {
    return rigFile(this.simulator.data, (name) => this.variants.shown.values[this.slots.get(name)]);
  }

  /** Text of the shown run's file. */
  file() {
    return parameterFile(this.simulator.data, this.variants.shown.values);
  }

  save() {
    saveAs(this.fileName, this.file(), "application/toml");
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
