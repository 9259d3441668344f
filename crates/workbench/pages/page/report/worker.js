// Simulates beside the page, so that sliders do not wait. The first message brings the module and the recording, every
// other one a set of parameters, a rig, or the wish to abandon the simulation.

import { Module } from "../shared/module.js";

let simulation = null;
let samples = 0;
let isAbandoned = false;

/** Time of the first part, for which the first curve waits [ms]. Each further part takes longer, so that drawing takes little. */
const FIRST_PART = 16;
const GROWTH = 4;
/** Most time between looks for messages, for which a change waits [ms]. */
const TURN = 25;
/** Samples between looks at the clock. */
const STRIDE = 20;

const turns = new MessageChannel();

/** Lets messages in. */
const turn = () => new Promise((resolve) => {
  turns.port1.onmessage = resolve;
  turns.port2.postMessage(null);
});

const curves = () => simulation.view(Float32Array, simulation.calls.curves(), simulation.calls.curves_length()).slice();

/** Sends the curves part by part; the answer is what follows them. */
async function simulated(values) {
  const { calls } = simulation;
  isAbandoned = false;
  simulation.hand(values);
  if (!calls.begin()) return { reason: simulation.text() };
  const head = JSON.parse(simulation.text());
  let count = 0;
  for (let duration = FIRST_PART; count < samples; duration *= GROWTH) {
    count = await advanced(performance.now() + duration);
    if (isAbandoned) break;
    const part = { ...head, from: calls.part(), to: count, curves: curves() };
    postMessage({ part }, [part.curves.buffer]);
    await turn();
  }
  if (isAbandoned) return { isAbandoned };
  return calls.finish() ? { ...JSON.parse(simulation.text()), tilt: Uint8Array.from(curves()) } : { reason: simulation.text() };
}

/** Simulates up to a time, and returns the number of samples so far. */
async function advanced(end) {
  let count = 0;
  while (!isAbandoned) {
    const next = Math.min(end, performance.now() + TURN);
    do count = simulation.calls.advance(STRIDE); while (count < samples && performance.now() < next);
    if (count === samples || next === end) return count;
    await turn();
  }
  return count;
}

function checked(rig) {
  simulation.hand(rig);
  return simulation.calls.check_rig() ? JSON.parse(simulation.text()) : { reason: simulation.text() };
}

async function prepare({ module, recorded }) {
  simulation = await Module.start(module);
  simulation.hand(recorded);
  samples = simulation.calls.record();
  return { samples };
}

onmessage = async ({ data }) => {
  if (data.abandon) {
    isAbandoned = true;
    return;
  }
  try {
    postMessage(await (data.module ? prepare(data) : data.rig ? checked(data.rig) : simulated(data.values)));
  } catch (error) {
    postMessage({ failure: String(error) });
  }
};
