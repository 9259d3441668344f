"""The FMU of FMI 3.0 with array variables, against the one of FMI 2.0: the same numbers, bit for bit."""

import os
import shutil
import zipfile
from ctypes import c_double, c_int32, c_uint32
from pathlib import Path

import numpy as np
import pytest
from conftest import ANGLES, AXES, TARGET
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

LEGS = range(1, 7)


def components(name, components):
    return [f"{name}.{component}" for component in components]


# What FMI 3.0 has as an array, and the scalar variables of FMI 2.0 that are its elements.
INPUTS = {
    "vehicle.specificForce": components("vehicle.specificForce", AXES),
    "vehicle.angularVelocity": components("vehicle.angularVelocity", AXES),
    "vehicle.orientation": components("vehicle.orientation", ANGLES),
    "vehicle.speed": ["vehicle.speed"],
    "rider.lean": ["rider.lean"],
}
OUTPUTS = {
    "platform.position": components("platform.position", AXES),
    "platform.velocity": components("platform.velocity", AXES),
    "platform.acceleration": components("platform.acceleration", AXES),
    "platform.orientation": components("platform.orientation", ANGLES),
    "platform.angularVelocity": components("platform.angularVelocity", AXES),
    "actuator.length": [f"actuator[{i}].length" for i in LEGS],
    "actuator.velocity": [f"actuator[{i}].velocity" for i in LEGS],
    "rider.specificForce": components("rider.specificForce", AXES),
    "rider.angularVelocity": components("rider.angularVelocity", AXES),
    "tilt.roll": ["tilt.roll"],
    "tilt.pitch": ["tilt.pitch"],
    "tilt.rollRate": ["tilt.rollRate"],
    "tilt.pitchRate": ["tilt.pitchRate"],
    "status.strokeMargin": ["status.strokeMargin"],
}
# Outputs that are constant here: of the strategy predictive, of the automatic scale, and of cranks.
ELSEWHERE = {"predictive.planAge", "automaticScale.factor", "actuator.angle", "actuator.angularVelocity"}
# Parameters other than the start values, one of every type and shape.
PARAMETERS = {
    "splitter.omega1": ([1.5, 2.0, 3.0], [f"splitter.{a}.omega1" for a in AXES]),
    "angular.zeta1": ([0.8, 0.9, 1.1], [f"angular.{a}.zeta1" for a in ANGLES]),
    "tilt.rateLimit": ([0.07], ["tilt.rateLimit"]),
    "splitter.order": ([3], ["splitter.order"]),
    "compensation": ([2], ["compensation"]),
    "rig.base": (None, [f"rig.base[{i}].{a}" for i in LEGS for a in AXES]),
}


@pytest.fixture(scope="module")
def fmu3():
    path = Path(os.environ.get("MORIS_FMU3_ARRAYS", TARGET / "fmu" / "MorisWashout.fmi3.arrays.fmu"))
    assert path.exists(), f"{path} is missing: run `cargo build-fmu --fmi 3 --arrays`"
    return path


@pytest.fixture(scope="module")
def description3(fmu3):
    return read_model_description(fmu3)


@pytest.fixture(scope="module")
def unpacked3(fmu3):
    directory = extract(fmu3)
    yield directory
    shutil.rmtree(directory, ignore_errors=True)


@pytest.fixture
def washout3(description3, unpacked3):
    """Makes initialised instances: washout3(parameters) -> Washout3."""
    made = []

    def make(parameters=None):
        made.append(Washout3(description3, unpacked3, parameters or {}))
        return made[-1]

    yield make
    for instance in made:
        instance.slave.freeInstance()


class Washout3:
    """An instance of the FMU, by the names of its variables."""

    def __init__(self, description, unpacked, parameters):
        self.variables = {v.name: v for v in description.modelVariables}
        self.said = []
        self.slave = FMU3Slave(
            guid=description.guid,
            unzipDirectory=unpacked,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="test",
        )
        self.slave.instantiate(logMessage=lambda _, status, category, text: self.said.append(text.decode()))
        self.slave.enterInitializationMode(startTime=0.0)
        for name, values in parameters.items():
            self.set(name, values)
        self.slave.exitInitializationMode()

    def reference(self, name):
        return self.variables[name].valueReference

    def kind(self, name):
        kind = self.variables[name].type
        return "Int64" if kind == "Enumeration" else kind

    def set(self, name, values):
        getattr(self.slave, f"set{self.kind(name)}")([self.reference(name)], list(np.ravel(values)))

    def get(self, name):
        count = int(np.prod(self.variables[name].shape or (1,)))
        return list(getattr(self.slave, f"get{self.kind(name)}")([self.reference(name)], nValues=count))

    def run(self, step, inputs, start=0.0):
        """Steps through `inputs`, a row of all real inputs a step; returns all real outputs after each step."""
        references = [self.reference(name) for name in INPUTS]
        rows = []
        for k, row in enumerate(inputs):
            self.slave.setFloat64(references, row.tolist())
            self.slave.doStep(start + k * step, step)
            rows.append(self.slave.getFloat64([self.reference(name) for name in OUTPUTS], nValues=flat_count(OUTPUTS)))
        return np.array(rows)


def flat(names):
    return [scalar for scalars in names.values() for scalar in scalars]


def flat_count(names):
    return len(flat(names))


def shaken(count, seed=5):
    """A ride that shakes everything, a row a step."""
    rng = np.random.default_rng(seed)
    rows = rng.normal(0, 0.3, (count, flat_count(INPUTS)))
    rows[:, 2] += 9.80665
    return rows


def test_fmpy_finds_nothing_to_complain_of(fmu3):
    assert validate_fmu(str(fmu3)) == []


def test_the_names_are_those_of_fmi_2_without_indices_and_components(description, description3):
    scalars = {v.name for v in description.modelVariables}
    assert set(flat(INPUTS)) | set(flat(OUTPUTS)) <= scalars
    arrays = {v.name: v for v in description3.modelVariables}
    for name, elements in (INPUTS | OUTPUTS).items():
        assert arrays[name].shape == ((len(elements),) if len(elements) > 1 else ()), name
    assert arrays["rig.base"].shape == (6, 3)
    reals = [v for v in description3.modelVariables if v.type == "Float64"]
    assert {v.name for v in reals if v.causality == "output"} == set(OUTPUTS) | ELSEWHERE
    preview = {f"vehicle.preview.{name}" for name in ("step", "specificForce.x", "specificForce.y")}
    assert {v.name for v in reals if v.causality == "input"} == set(INPUTS) | preview
    assert arrays["vehicle.preview.specificForce.x"].shape == (20,)


def test_every_start_value_is_what_the_binary_returns(description3, washout3):
    w = washout3()
    compared = 0
    for variable in description3.modelVariables:
        values = w.get(variable.name)
        if variable.start is None:
            continue
        start = variable.start if isinstance(variable.start, (list, tuple)) else str(variable.start).split()
        if variable.type == "Boolean":
            start = [str(value).lower() in ("true", "1") for value in start]
        assert [float(value) for value in values] == [float(value) for value in start], variable.name
        compared += len(start)
    assert compared > 100


def test_a_ride_is_the_same_bit_for_bit_as_with_fmi_2(washout, washout3):
    scalar_parameters, array_parameters = {}, {}
    default = washout()
    for name, (values, scalars) in PARAMETERS.items():
        if values is None:
            # A rig that is not the default one, but nearly.
            values = [value * 1.001 for value in default.get(*scalars)]
        array_parameters[name] = values
        scalar_parameters |= dict(zip(scalars, values))
    w2, w3 = washout(parameters=scalar_parameters), washout3(array_parameters)
    inputs = shaken(2000)
    columns = dict(zip(flat(INPUTS), inputs.T))
    expected = w2.run(1e-3, columns, flat(OUTPUTS))
    assert np.array_equal(w3.run(1e-3, inputs), expected)
    assert np.all(np.ptp(expected, axis=0) > 0)
    assert w3.get("status.tiltLimited") == w2.slave.getBoolean(w2.references(["status.tiltLimited"]))


def test_output_derivatives_are_those_of_fmi_2(washout, washout3):
    w2, w3 = washout(), washout3()
    inputs = shaken(200)
    w2.run(1e-3, dict(zip(flat(INPUTS), inputs.T)), [])
    w3.run(1e-3, inputs)
    names = ["platform.position", "actuator.length", "tilt.roll"]
    scalars = [scalar for name in names for scalar in OUTPUTS[name]]
    # fmpy's getOutputDerivatives has room for one value a variable only.
    references = (c_uint32 * len(names))(*(w3.reference(name) for name in names))
    values = (c_double * len(scalars))()
    orders = (c_int32 * len(names))(1, 1, 1)
    w3.slave.fmi3GetOutputDerivatives(w3.slave.component, references, len(names), orders, values, len(scalars))
    expected = w2.slave.getRealOutputDerivatives(w2.references(scalars), [1] * len(scalars))
    assert list(values) == expected
    assert all(expected)


def test_fmpy_simulates_a_recording_to_the_same_numbers(fmu, fmu3):
    t = np.arange(0, 5, 0.01)
    force = np.column_stack([1.5 * np.clip(t - 1, 0, 1), 0.5 * np.sin(t), 9.80665 + 0.2 * np.sin(3 * t)])
    rate = np.column_stack([0.1 * np.sin(2 * t), 0.05 * np.sin(t), 0.1 * np.sin(t)])
    names = ["vehicle.specificForce", "vehicle.angularVelocity"]
    arrays = np.array(
        list(zip(t, force, rate)), dtype=[("time", np.float64)] + [(name, np.float64, (3,)) for name in names]
    )
    scalar_names = INPUTS[names[0]] + INPUTS[names[1]]
    scalars = np.array(
        [tuple(row) for row in np.column_stack([t, force, rate])],
        dtype=[("time", np.float64)] + [(name, np.float64) for name in scalar_names],
    )
    options = {"stop_time": 5, "output_interval": 0.001}
    as_arrays = simulate_fmu(
        str(fmu3),
        input=arrays,
        start_values={"tilt.rateLimit": 0.06, "scale.specificForce": [0.9, 0.8, 0.7], "gravityRemoval": 2},
        output=list(OUTPUTS),
        **options,
    )
    start_values = {f"scale.specificForce.{a}": value for a, value in zip(AXES, [0.9, 0.8, 0.7])}
    as_scalars = simulate_fmu(
        str(fmu),
        input=scalars,
        start_values=start_values | {"tilt.rateLimit": 0.06, "gravityRemoval": 2},
        output=flat(OUTPUTS),
        **options,
    )
    assert len(as_arrays) == len(as_scalars) == 5001
    for name, elements in OUTPUTS.items():
        expected = np.column_stack([as_scalars[element] for element in elements])
        assert np.array_equal(as_arrays[name].reshape(expected.shape), expected), name
    assert np.ptp(as_arrays["rider.specificForce"], axis=0).min() > 0.1


@pytest.mark.parametrize("model", ["MorisWashout", "Motorcycle", "StewartPlatform"])
def test_the_reference_ride_is_as_the_reference_says(model, tmp_path):
    path = TARGET / "fmu" / f"{model}.fmi3.arrays.fmu"
    with zipfile.ZipFile(path) as archive:
        for end in ("in", "ref"):
            name = f"extra/org.fmi-standard.fmi-ls-ref/{model}_{end}.csv"
            (tmp_path / f"{end}.csv").write_bytes(archive.read(name))
    ride, reference = (read_csv(str(tmp_path / f"{end}.csv")) for end in ("in", "ref"))
    inputs, outputs = ride.dtype.names[1:], reference.dtype.names[1:]
    description, directory = read_model_description(path), extract(path)
    instance = Washout3(description, directory, {})
    step, largest, moved = 0.01, 0.0, 0.0
    for k in range(round(reference["time"][-1] / step)):
        for name in inputs:
            columns = np.asarray(ride[name]).reshape(len(ride), -1).T
            instance.set(name, [np.interp(k * step, ride["time"], column) for column in columns])
        instance.slave.doStep(k * step, step)
        row = np.flatnonzero(np.abs(reference["time"] - (k + 1) * step) < 1e-9)
        for name in outputs if row.size else ():
            expected = np.ravel(reference[name][row[0]])
            largest = max(largest, np.abs(np.array(instance.get(name)) - expected).max())
            moved = max(moved, np.abs(expected - np.ravel(reference[name][0])).max())
    instance.slave.freeInstance()
    shutil.rmtree(directory, ignore_errors=True)
    # A plan's active limits depend on the last digits of the ride's table.
    assert largest < (1e-3 if model == "MorisWashout" else 1e-9) and moved > 0.1


def test_states_repeat_bit_for_bit_here_and_in_another_instance(washout3):
    w = washout3({"splitter.omega1": [1.5, 2.0, 3.0]})
    w.run(1e-3, shaken(200))
    state = w.slave.getFMUState()
    serialized = w.slave.serializeFMUState(state)
    expected = w.run(1e-3, shaken(200, seed=6), start=0.2)
    w.slave.setFMUState(state)
    w.slave.freeFMUState(state)
    assert np.array_equal(w.run(1e-3, shaken(200, seed=6), start=0.2), expected)
    other = washout3()
    read = other.slave.deserializeFMUState(serialized)
    other.slave.setFMUState(read)
    other.slave.freeFMUState(read)
    assert np.array_equal(other.run(1e-3, shaken(200, seed=6), start=0.2), expected)


def test_what_is_wrong_is_refused_with_a_reason_and_the_instance_lives_on(washout3):
    w = washout3()
    with pytest.raises(FMICallException):
        w.slave.setFloat64([w.reference("vehicle.specificForce")], [1.0, 2.0])
    assert "'vehicle.specificForce' has 3 values, and the call comes with 2" in w.said[-1]
    w.said.clear()
    with pytest.raises(FMICallException):
        w.set("tilt.rateLimit", [np.nan])
    with pytest.raises(FMICallException):
        w.set("vehicle.angularVelocity", [0.0, np.nan, 0.0])
    with pytest.raises(FMICallException):
        w.set("rig.base", np.zeros(18))
    assert "rig.base" in w.said[-1]
    with pytest.raises(FMICallException):
        w.slave.enterEventMode()
    assert "not allowed in state 'step mode'" in w.said[-1]
    assert w.get("vehicle.specificForce") == [0.0, 0.0, 9.80665]
    w.slave.doStep(0.0, 0.001)
