// Runs with parameters of their own: the one by hand, and those kept by name, to choose, compare, rename and delete.

import { element } from "../shared/dom.js";
import { report, runStyle } from "./data.js";

const BY_HAND = "by hand";

/** A button of the panel. */
export function panelButton(text, title, act) {
  const made = element("button", { type: "button", title }, [text]);
  made.addEventListener("click", act);
  return made;
}

export class Variants {
  /** `show(run)` shows a run, and every curve and measure anew; `say(text)` says what cannot be done. */
  constructor(show, say) {
    Object.assign(this, { show, say, shown: report.runs[0], looks: report.runs.length });
    this.name = element("input", { id: "variant-name", maxlength: "40", placeholder: this.freeName() });
    this.name.addEventListener("keydown", (event) => { if (event.key === "Enter") this.keep(); });
    this.keepButton = panelButton("Keep", "Keep the shown parameters under this name", () => this.keep());
    this.renameButton = panelButton("Rename", "Give the shown variant this name", () => this.rename());
    this.deleteButton = panelButton("Delete", "Delete the shown variant", () => this.remove());
    this.other = element("select", { id: "variant-other" });
    this.other.addEventListener("change", () => this.showState());
    this.compareButton = panelButton("Compare", "Show the other run, and back", () => this.compare());
    const label = (id, text) => element("label", { for: id }, [text]);
    this.element = element("div", { class: "variants" }, [
      element("div", { class: "tools" }, [label("variant-name", "Name"), this.name, this.keepButton, this.renameButton, this.deleteButton]),
      element("div", { class: "tools" }, [label("variant-other", "Compare with"), this.other, this.compareButton]),
    ]);
    this.showState();
  }

  /** The run that is called so. */
  named(name) {
    return report.runs.find((run) => run.name === name);
  }

  freeName() {
    let number = 1;
    while (this.named(`variant ${number}`)) number += 1;
    return `variant ${number}`;
  }

  /** The wanted name; none if another run has it. */
  wantedName() {
    const name = this.name.value.trim() || this.name.placeholder;
    if (!this.named(name) && name !== BY_HAND) return name;
    this.say(`There is a run called ${name} already.`);
    return null;
  }

  /** Adds a run behind the others, with a look of its own. */
  add(run) {
    const added = { ...run, ...runStyle(this.looks), index: report.runs.length };
    this.looks += 1;
    report.runs.push(added);
    return added;
  }

  /** Puts a run in the place of the one by hand. */
  putByHand(run) {
    const before = this.named(BY_HAND);
    if (!before) return this.add({ ...run, name: BY_HAND });
    const { index, colour: paint, dash } = before;
    report.runs[index] = { ...run, name: BY_HAND, index, colour: paint, dash };
    return report.runs[index];
  }

  /** Takes the run by hand away, and returns the one that was shown before it. */
  withoutByHand() {
    this.take(this.named(BY_HAND).index);
    return this.shown;
  }

  take(index) {
    report.runs.splice(index, 1);
    report.runs.forEach((run, i) => { run.index = i; });
  }

  keep() {
    const name = this.wantedName();
    if (!name || !this.shown.values) return;
    this.name.value = "";
    this.show(this.add({ ...this.shown, name, isKept: true }));
    this.say(`Kept as ${name}.`);
  }

  rename() {
    const name = this.wantedName();
    if (!name) return;
    const isOther = this.other.value === this.shown.name;
    this.name.value = "";
    this.shown.name = name;
    this.showState();
    if (isOther) this.other.value = name;
    this.show(this.shown);
  }

  remove() {
    const { index, name } = this.shown;
    this.take(index);
    this.show(this.named(BY_HAND) ?? report.runs[0]);
    this.say(`Deleted ${name}.`);
    this.keepButton.focus();
  }

  /** Goes to the other run, and from it back to the one that was shown before. */
  compare() {
    const other = this.named(this.other.value);
    if (this.shown !== other) this.before = this.shown.name;
    const back = this.named(this.before) ?? this.named(BY_HAND) ?? report.runs.find((run) => run !== other);
    this.show(this.shown === other ? back : other);
  }

  /** Takes note of the shown run. */
  see(run) {
    this.shown = run;
    this.showState();
  }

  showState() {
    const names = report.runs.map(({ name }) => name);
    if (names.join("\n") !== [...this.other.options].map(({ value }) => value).join("\n")) {
      const chosen = this.other.value;
      this.other.replaceChildren(...names.map((name) => element("option", { value: name }, [name])));
      this.other.value = names.includes(chosen) ? chosen : names[0];
      this.name.placeholder = this.freeName();
    }
    this.keepButton.disabled = !this.shown.values;
    this.renameButton.disabled = !this.shown.isKept;
    this.deleteButton.disabled = !this.shown.isKept;
    this.compareButton.disabled = report.runs.length < 2;
    this.compareButton.setAttribute("aria-pressed", String(report.runs.length > 1 && this.shown.name === this.other.value));
  }
}
