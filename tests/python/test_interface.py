"""The FMU as importers see it: validation, start values, states, steps."""

import multiprocessing

import numpy as np
import pytest
from conftest import AXES, Washout
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

POSE = [f"platform.position.{a}" for a in AXES] + ["platform.orientation.pitch", "rider.specificForce.x"]
LEGS = [f"actuator[{i}].length" for i in range(1, 7)]


def test_fmpy_finds_nothing_to_complain_of(fmu):
    assert validate_fmu(str(fmu)) == []


def test_every_start_value_is_what_the_binary_returns(description, washout):
    w = washout()
    compared = 0
    for variable in description.modelVariables:
        if variable.start is None:
            continue
        reference = [variable.valueReference]
        if variable.type == "Real":
            assert w.slave.getReal(reference)[0] == float(variable.start), variable.name
        elif variable.type == "Boolean":
            assert w.slave.getBoolean(reference)[0] == (variable.start in ("true", "1")), variable.name
        else:
            assert w.slave.getInteger(reference)[0] == int(variable.start), variable.name
        compared += 1
    assert compared > 100


def ramp(t):
    return 0.4 * np.clip(t - 1.0, 0.0, 4.0)


# The paper's filters and tilt limits, with which the tilt's acceleration does not switch at the instants compared.
PAPER = {
    "splitter.order": 4,
    **{f"splitter.{axis}.{omega}": 2.5 for axis in AXES for omega in ("omega1", "omega2")},
    **{f"splitter.{axis}.{zeta}": 1.0 for axis in AXES for zeta in ("zeta1", "zeta2")},
    **{f"scale.specificForce.{axis}": 1.0 for axis in AXES},
    "tilt.rateLimit": np.radians(3.0),
    "tilt.accelerationLimit": 0.2,
    "tilt.angleLimit": 0.38,
}


def ramped(washout, boundaries):
    """The state after a ramp from 1 s to 5 s, stepped over these boundaries with the input's slope given."""
    w = washout(parameters=PAPER)
    references = w.references(["vehicle.specificForce.x"])
    for begin, end in zip(boundaries[:-1], boundaries[1:]):
        w.slave.setReal(references, [ramp(begin)])
        w.slave.setRealInputDerivatives(references, [1], [(ramp(end) - ramp(begin)) / (end - begin)])
        w.slave.doStep(begin, end - begin)
    return w.get(*POSE, *LEGS)


def test_the_communication_step_does_not_matter(washout):
    rng = np.random.default_rng(7)
    for stop in (3.0, 6.0):
        fine = ramped(washout, np.linspace(0, stop, round(stop * 1000) + 1))
        for step in (5e-3, 1e-2):
            coarse = ramped(washout, np.linspace(0, stop, round(stop / step) + 1))
            assert np.max(np.abs(coarse - fine)) < 1e-3
        irregular = np.sort(np.concatenate([[0.0, 1.0, stop], rng.uniform(0, stop, 700)]))
        assert np.max(np.abs(ramped(washout, irregular) - fine)) < 1e-3


def hostile_inputs(count):
    rng = np.random.default_rng(3)
    return {
        "vehicle.specificForce.x": rng.normal(0, 3, count),
        "vehicle.specificForce.y": rng.normal(0, 3, count),
        "vehicle.angularVelocity.x": rng.normal(0, 0.2, count),
    }


def test_a_run_repeats_bit_for_bit_after_going_back(washout):
    w = washout()
    inputs = hostile_inputs(400)
    first_half = {name: values[:200] for name, values in inputs.items()}
    second_half = {name: values[200:] for name, values in inputs.items()}
    w.run(1e-3, first_half, POSE)
    state = w.slave.getFMUstate()
    once = w.run(1e-3, second_half, POSE + LEGS)
    w.slave.setFMUstate(state)
    w.slave.freeFMUstate(state)
    w.time = 0.2
    assert np.array_equal(once, w.run(1e-3, second_half, POSE + LEGS))


def continue_from(arguments):
    description, unpacked, serialized, inputs = arguments
    w = Washout(description, unpacked)
    state = w.slave.deSerializeFMUstate(serialized)
    w.slave.setFMUstate(state)
    w.time = 0.2
    return w.run(1e-3, inputs, POSE + LEGS)


def test_a_serialised_state_continues_in_another_process(description, unpacked, washout):
    w = washout()
    inputs = hostile_inputs(400)
    w.run(1e-3, {name: values[:200] for name, values in inputs.items()}, POSE)
    state = w.slave.getFMUstate()
    serialized = w.slave.serializeFMUstate(state)
    second_half = {name: values[200:] for name, values in inputs.items()}
    here = w.run(1e-3, second_half, POSE + LEGS)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.map(continue_from, [(description, unpacked, serialized, second_half)])[0]
    assert np.array_equal(here, there)


@pytest.mark.parametrize(
    "name, value",
    [("splitter.x.omega1", 0.0), ("splitter.y.zeta2", -1.0), ("actuator.minLength", 1.7), ("rig.neutralHeight", 2.0)],
)
def test_bad_parameters_are_refused_and_the_instance_lives_on(description, unpacked, name, value):
    w = Washout(description, unpacked)
    w.slave.reset()
    w.slave.setupExperiment(startTime=0.0)
    w.slave.enterInitializationMode()
    good = w.get(name)[0]
    with pytest.raises(FMICallException):
        w.set({name: value})
        w.slave.exitInitializationMode()
    w.set({name: good})
    w.slave.exitInitializationMode()
    w.slave.doStep(0.0, 0.001)
    w.slave.freeInstance()


def test_one_line_runs_a_recording(fmu):
    t = np.arange(0, 20, 0.01)
    forward = 1.5 * np.clip((t - 2) / 5, 0, 1)
    signals = np.array(
        list(zip(t, forward)), dtype=[("time", np.float64), ("vehicle.specificForce.x", np.float64)]
    )
    result = simulate_fmu(
        str(fmu), stop_time=20, output_interval=0.001, input=signals, output=["rider.specificForce.x"]
    )
    assert abs(result["rider.specificForce.x"][-1] - 1.5) < 1e-3
