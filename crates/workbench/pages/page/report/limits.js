// The time line of what was limited, and the list of it with reasons.

import { fixed } from "../shared/format.js";
import { element } from "../shared/dom.js";
import { colour } from "../shared/palette.js";
import { drawTimeAxis, MARGIN, Plot, plotWidth, xOf } from "./chart.js";

const KINDS = {
  tilt: { label: "tilt", long: "tilt limited", colour: "--tilt", help: "Tilt coordination lagged behind its target at its rate or angle limit, or for at least 0.1 s at its acceleration limit." },
  soft: { label: "soft", long: "soft limits", colour: "--soft", help: "The soft limits changed the motion ahead of a limit of a leg or a safety unit." },
  safety: { label: "safety", long: "safety unit", colour: "--safety", help: "A safety unit limited the platform from its position, velocity or acceleration limit." },
  actuator: { label: "legs", long: "actuator guard", colour: "--actuator", help: "The actuator guard limited a leg's stroke, speed or acceleration." },
};
const LANE = 20;

/** How long a flag was up: it speaks of the step before its sample. */
function timeLimited(run, flags) {
  let sum = 0;
  for (let i = 1; i < flags.length; i += 1) if (flags[i]) sum += run.times[i] - run.times[i - 1];
  return sum;
}

/** One lane for each kind of limit. */
export class TimeLine {
  constructor(shown, handlers) {
    this.shown = shown;
    this.events = [];
    this.plot = new Plot(Object.keys(KINDS).length * LANE + MARGIN.top + MARGIN.bottom, shown, handlers);
    this.summary = element("p", { class: "summary" });
    this.list = element("tbody");
    const table = element("table", {}, [this.list]);
    this.printed = element("p", { class: "summary print-only" });
    this.element = element("div", {}, [this.plot.box, this.summary, element("div", { class: "events" }, [table]), this.printed]);
    this.seek = handlers.seek;
  }

  select(run) {
    this.events = run.events;
    const [first, last] = [run.times[0], run.times[run.times.length - 1]];
    const fractions = Object.entries(KINDS).map(([kind, { long }]) => {
      const time = timeLimited(run, run.limited[kind]);
      return time > 0 ? `${long} ${fixed(time, 1)} s (${fixed(100 * time / (last - first), 0)} %)` : null;
    }).filter(Boolean);
    this.plot.canvas.setAttribute("aria-label", `Times of active limits: ${this.events.length} in all, listed below`);
    this.summary.textContent = fractions.length > 0 ? `Of ${fixed(last - first, 1)} s: ${fractions.join(", ")}.` : "No limit was active.";
    this.element.querySelector(".events").hidden = this.events.length === 0;
  }

  /** Fills the list; a long one takes a while. */
  showList() {
    this.list.replaceChildren(...this.events.map((event) => this.row(event)));
    // A print has the summary alone.
    this.printed.textContent = this.events.length > 0 ? `${this.events.length} times in all; the page lists them with their reasons.` : "";
  }

  row(event) {
    const { long, colour: paint } = KINDS[event.kind];
    const mark = element("span", { class: "mark", style: `background: var(${paint})` });
    const times = `${fixed(event.from, 2)} to ${fixed(event.to, 2)} s`;
    const row = element("tr", { title: "Go there" }, [
      element("td", { class: "number" }, [element("button", { type: "button", "aria-label": `Go to ${times}, ${long}` }, [times])]),
      element("td", {}, [mark, long]),
      element("td", {}, [event.why]),
    ]);
    row.addEventListener("click", () => this.seek(event.from));
    return row;
  }

  moveCursor(time) {
    this.plot.moveCursor(time);
  }

  read(time) {
    this.plot.moveCursor(time, this.plot.reader);
  }

  draw() {
    const { context, width, height } = this.plot.fitted();
    const shown = this.shown();
    drawTimeAxis(context, shown, width, height);
    Object.entries(KINDS).forEach(([kind, { label, colour: paint }], lane) => {
      const y = MARGIN.top + lane * LANE;
      context.textAlign = "right";
      context.textBaseline = "middle";
      context.fillStyle = colour("--muted");
      context.fillText(label, MARGIN.left - 6, y + LANE / 2);
      context.fillStyle = colour("--lane");
      context.fillRect(MARGIN.left, y + 3, plotWidth(width), LANE - 6);
      context.fillStyle = colour(paint);
      for (const { from, to } of this.events.filter((event) => event.kind === kind)) {
        const [a, b] = [from, to].map((time) => Math.min(width - MARGIN.right, Math.max(MARGIN.left, xOf(time, shown, width))));
        if (to > shown[0] && from < shown[1]) context.fillRect(a, y + 3, Math.max(1.5, b - a), LANE - 6);
      }
    });
  }
}

/** What is limited at the moment, as chips beside the machine. */
export class Chips {
  constructor(list) {
    this.chips = Object.entries(KINDS).map(([kind, { long, colour: paint, help }]) => {
      const chip = element("li", { title: help, style: `--chip: var(${paint})` }, [long]);
      list.append(chip);
      return { kind, chip };
    });
  }

  update(state) {
    for (const { kind, chip } of this.chips) chip.classList.toggle("lit", Boolean(state.limited[kind]));
  }
}
