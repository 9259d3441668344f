// Simulates beside the page, so that sliders do not wait. The first message brings the module and the recording, every
// other one a set of parameters.
"use strict";
let simulation = null;

/** Writes numbers for the module to read. Its memory may move when it grows, and is asked for after that. */
function hand(values) {
  const address = simulation.numbers(values.length);
  new Float64Array(simulation.memory.buffer, address, values.length).set(values);
}

const answerText = () => new TextDecoder().decode(new Uint8Array(simulation.memory.buffer, simulation.text(), simulation.text_length()));

function simulated(values) {
  hand(values);
  if (!simulation.simulate()) return { reason: answerText() };
  const curves = new Float32Array(simulation.memory.buffer, simulation.curves(), simulation.curves_length()).slice();
  return { ...JSON.parse(answerText()), curves };
}

async function prepare({ module, recorded }) {
  const { instance } = await WebAssembly.instantiate(module, {});
  simulation = instance.exports;
  hand(recorded);
  return { samples: simulation.record() };
}

onmessage = async ({ data }) => {
  try {
    const begin = performance.now();
    const answer = data.module ? await prepare(data) : simulated(data.values);
    postMessage({ ...answer, took: performance.now() - begin }, answer.curves ? [answer.curves.buffer] : []);
  } catch (error) {
    postMessage({ failure: String(error) });
  }
};
