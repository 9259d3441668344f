// Simulates beside the page, so that sliders do not wait. The first message brings the module and the recording, every
// other one a set of parameters.
let simulation = null;

function simulated(values) {
  simulation.hand(values);
  if (!simulation.calls.simulate()) return { reason: simulation.text() };
  const curves = simulation.view(Float32Array, simulation.calls.curves(), simulation.calls.curves_length()).slice();
  return { ...JSON.parse(simulation.text()), curves };
}

function checked(rig) {
  simulation.hand(rig);
  return simulation.calls.check_rig() ? JSON.parse(simulation.text()) : { reason: simulation.text() };
}

async function prepare({ module, recorded }) {
  simulation = await Module.start(module);
  simulation.hand(recorded);
  return { samples: simulation.calls.record() };
}

onmessage = async ({ data }) => {
  try {
    const begin = performance.now();
    const answer = data.module ? await prepare(data) : data.rig ? checked(data.rig) : simulated(data.values);
    postMessage({ ...answer, took: performance.now() - begin }, answer.curves ? [answer.curves.buffer] : []);
  } catch (error) {
    postMessage({ failure: String(error) });
  }
};
