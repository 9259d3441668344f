"""The ranges in the descriptions are what the binaries do, for every variable of every model."""

import math
import os
from pathlib import Path

import pytest
from conftest import TARGET, stated
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi1 import FMICallException

FMUS = Path(os.environ.get("MORIS_FMUS", TARGET / "fmu"))
MODELS = ["MorisWashout", "Motorcycle", "StewartPlatform"]
DEGREES = {"rad": "deg", "rad/s": "deg/s", "rad/s2": "deg/s2"}


@pytest.fixture(scope="module", params=[f"{model}{end}" for model in MODELS for end in (".fmu", ".fmi3.fmu")])
def fmu(request):
    path = FMUS / request.param
    assert path.exists(), f"{path} is missing: run `cargo build-fmu` and `cargo build-fmu --fmi 3`"
    return path


@pytest.fixture(scope="module")
def description(fmu):
    return read_model_description(fmu)


def is_real(variable):
    return variable.type in ("Real", "Float64")


def set_by_host(description, *causalities):
    variables = [v for v in description.modelVariables if v.causality in causalities and v.type != "Boolean"]
    assert len(variables) > 5
    return variables


def instance(fmu, description, directory):
    made = instantiate_fmu(directory, description, "CoSimulation", debug_logging=True)
    if description.fmiVersion == "2.0":
        made.setupExperiment(startTime=0.0)
    made.enterInitializationMode()
    return made


def set_value(made, variable, value):
    setter = {
        "Real": "setReal",
        "Integer": "setInteger",
        "Enumeration": "setInt64" if hasattr(made, "setInt64") else "setInteger",
        "Float64": "setFloat64",
        "Int32": "setInt32",
    }[variable.type]
    getattr(made, setter)([variable.valueReference], [value if is_real(variable) else int(value)])


def beyond(variable):
    low, high = float(variable.min), float(variable.max)
    if is_real(variable):
        return math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
    return low - 1, high + 1


def test_everything_that_is_set_has_a_range_with_its_start_value_inside(description):
    for variable in set_by_host(description, "input", "parameter"):
        assert variable.min is not None and variable.max is not None, variable.name
        assert float(variable.min) <= float(variable.start) <= float(variable.max), variable.name


def test_units_come_with_quantities_and_angular_ones_with_degrees(description):
    for variable in description.modelVariables:
        if is_real(variable) and (unit := stated(variable, "unit")):
            assert stated(variable, "quantity"), variable.name
            frequency = stated(variable, "quantity") == "AngularFrequency"
            assert stated(variable, "displayUnit") == (None if frequency else DEGREES.get(unit)), variable.name
    units = {stated(v, "unit") for v in description.modelVariables if is_real(v)}
    assert {"s", "m", "m/s", "m/s2", "rad"} <= units
    forces = [v for v in description.modelVariables if is_real(v) and stated(v, "unit") == "N"]
    assert all(float(stated(v, "nominal")) == 1000 for v in forces)


def test_parameters_take_the_ends_of_their_range_and_nothing_beyond(fmu, description, capsys, tmp_path):
    made = instance(fmu, description, extract(fmu, unzipdir=tmp_path))
    for variable in set_by_host(description, "parameter"):
        for value in (float(variable.min), float(variable.max)):
            set_value(made, variable, value)
        for value in beyond(variable):
            capsys.readouterr()
            with pytest.raises(FMICallException) as error:
                set_value(made, variable, value)
            assert error.value.status == 2, f"{variable.name}: fmi2Discard, fmi3Discard"
            assert f"'{variable.name}'" in capsys.readouterr().out, variable.name
    made.freeInstance()


def test_tunable_parameters_are_discarded_between_steps(fmu, description, capsys, tmp_path):
    made = instance(fmu, description, extract(fmu, unzipdir=tmp_path))
    made.exitInitializationMode()
    tunable = [v for v in set_by_host(description, "parameter") if v.variability == "tunable"]
    assert len(tunable) > 10
    for variable in tunable:
        for value in beyond(variable):
            capsys.readouterr()
            with pytest.raises(FMICallException) as error:
                set_value(made, variable, value)
            assert error.value.status == 2
            assert f"'{variable.name}'" in capsys.readouterr().out, variable.name
        set_value(made, variable, float(variable.start))
    made.doStep(0.0, 0.001)
    made.freeInstance()


def test_inputs_beyond_their_range_do_not_end_a_run(fmu, description, tmp_path):
    made = instance(fmu, description, extract(fmu, unzipdir=tmp_path))
    made.exitInitializationMode()
    # A whole number is not rounded: beyond its range it is discarded, as a parameter is.
    inputs = [v for v in set_by_host(description, "input") if v.type in ("Real", "Float64")]
    for k, variable in enumerate(inputs):
        for value in beyond(variable):
            set_value(made, variable, value)
        made.doStep(0.001 * k, 0.001)
        set_value(made, variable, float(variable.start))
    made.freeInstance()
