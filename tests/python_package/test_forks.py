"""Functions that use all cores, in a process that was forked after its parent had used them."""

import multiprocessing
import sys

import moris
import numpy as np
import pytest
from conftest import gentle

TIMEOUT = 300.0
RIDE = gentle(8.0)


def recording():
    return moris.Recording(RIDE, name="ride")


ERROR = "specific force x RMS error"
FELT = np.column_stack([RIDE[name] for name in ("ax", "ay", "az")])
CALLS = {
    "simulate": lambda: moris.simulate(RIDE).measures[ERROR],
    "simulate with the bound": lambda: moris.simulate(RIDE, bound=True).measures[ERROR],
    "bound": lambda: moris.bound(recording())["surge"].rms_error,
    "sweep": lambda: moris.sweep(RIDE, [{"scale.specificForce.x": x} for x in (0.4, 0.7)]).value[1][ERROR][0],
    "fit": lambda: moris.fit(recording(), strategy="classical").best.scale,
    "tune": lambda: moris.tune([recording()], groups=["scale"], evaluations=6, patience=3).error,
    "survey": lambda: moris.survey(samples=2000).reach["heave"].max,
    "frequency_response": lambda: np.abs(moris.frequency_response(parameters="paper").ratios).sum(),
    "measure": lambda: moris.measure(RIDE, felt_force=FELT, felt_rate=0.0 * FELT).measures[ERROR],
}


def answer(name, queue):
    queue.put(float(CALLS[name]()))


@pytest.mark.skipif(sys.platform != "linux", reason="forks by default on Linux alone")
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize("name", CALLS)
def test_a_forked_process_answers_as_its_parent(name):
    expected = float(CALLS[name]())
    # All cores have been used by now, whatever the function.
    moris.bound(recording())
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=answer, args=(name, queue), daemon=True)
    child.start()
    try:
        assert queue.get(timeout=TIMEOUT) == pytest.approx(expected, rel=1e-12)
    finally:
        child.terminate()
        child.join()
