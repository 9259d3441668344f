"""Every model's FMUs, of both versions of FMI, as an importer first sees them: valid, and starting as they say."""

import shutil

import numpy as np
import pytest
from conftest import TARGET
from conftest import Washout as Instance
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

MODELS = ["MorisWashout", "Motorcycle", "StewartPlatform"]


def fmu(name):
    path = TARGET / "fmu" / name
    assert path.exists(), f"{path} is missing: run `python3 tests/run.py --only fmu`"
    return path


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("version", ["fmu", "reals.fmu", "fmi3.fmu", "fmi3.arrays.fmu"])
def test_fmpy_finds_nothing_to_complain_of_and_steps_it(model, version):
    path = fmu(f"{model}.{version}")
    assert validate_fmu(str(path)) == []
    result = simulate_fmu(str(path), stop_time=0.1, output_interval=0.01)
    assert len(result) == 11
    for name in result.dtype.names:
        assert np.all(np.isfinite(result[name].astype(float))), name


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("version", ["fmu", "reals.fmu"])
def test_every_start_value_is_what_the_binary_returns(model, version):
    path = fmu(f"{model}.{version}")
    description, directory = read_model_description(path), extract(path)
    instance = Instance(description, directory)
    try:
        for variable in description.modelVariables:
            if variable.start is None:
                continue
            reference = [variable.valueReference]
            if variable.type == "Real":
                assert instance.slave.getReal(reference)[0] == float(variable.start), variable.name
            elif variable.type == "Boolean":
                assert instance.slave.getBoolean(reference)[0] == (variable.start in ("true", "1")), variable.name
            else:
                assert instance.slave.getInteger(reference)[0] == int(variable.start), variable.name
    finally:
        instance.slave.freeInstance()
        shutil.rmtree(directory, ignore_errors=True)


@pytest.mark.parametrize("model", MODELS)
def test_a_host_that_knows_only_reals_writes_all_and_reads_all(model):
    """It writes inputs and parameters at every step, as GEMSEO does, and has no function for any other type."""
    runs = {}
    for version in ("fmu", "reals.fmu"):
        description, directory = read_model_description(fmu(f"{model}.{version}")), extract(fmu(f"{model}.{version}"))
        assert version == "fmu" or {variable.type for variable in description.modelVariables} == {"Real"}
        instance = Instance(description, directory)
        try:
            rows = []
            for step in range(20):
                for variable in description.modelVariables:
                    if variable.causality in ("input", "parameter"):
                        start = {"false": 0.0, "true": 1.0}.get(variable.start) if variable.type == "Boolean" else float(variable.start)
                        excited = variable.name in ("vehicle.specificForce.x", "command.throttle", "command[1].length")
                        instance.set({variable.name: start + (0.01 * step if excited else 0.0)})
                instance.slave.doStep(0.01 * step, 0.01)
                read = {"Real": instance.slave.getReal, "Boolean": instance.slave.getBoolean}
                outputs = [variable for variable in description.modelVariables if variable.causality == "output"]
                rows.append([float(read.get(v.type, instance.slave.getInteger)([v.valueReference])[0]) for v in outputs])
            runs[version] = np.array(rows)
        finally:
            instance.slave.freeInstance()
            shutil.rmtree(directory, ignore_errors=True)
    assert np.array_equal(runs["fmu"], runs["reals.fmu"])
    assert np.ptp(runs["fmu"], axis=0).max() > 0


@pytest.mark.parametrize("model", MODELS)
def test_a_run_repeats_bit_for_bit_after_going_back(model):
    path = fmu(f"{model}.fmu")
    description, directory = read_model_description(path), extract(path)
    instance = Instance(description, directory)
    try:
        inputs = [v.name for v in description.modelVariables if v.causality == "input" and v.type == "Real"]
        outputs = [v.name for v in description.modelVariables if v.causality == "output" and v.type == "Real"]
        rng = np.random.default_rng(2)
        rows = {name: instance.get(name)[0] + 0.05 * rng.normal(size=200) for name in inputs}
        instance.run(1e-3, rows, outputs)
        state, time = instance.slave.getFMUstate(), instance.time
        once = instance.run(1e-3, rows, outputs)
        instance.slave.setFMUstate(state)
        instance.slave.freeFMUstate(state)
        instance.time = time
        assert np.array_equal(once, instance.run(1e-3, rows, outputs))
        assert np.ptp(once, axis=0).max() > 0
    finally:
        instance.slave.freeInstance()
        shutil.rmtree(directory, ignore_errors=True)
