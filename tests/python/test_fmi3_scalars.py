"""The FMUs of FMI 3.0 with scalar variables, against those of FMI 2.0: the same names and, bit for bit, the same numbers."""

import io
import zipfile

import numpy as np
import pytest
from conftest import TARGET, stated
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv

MODELS = ["MorisWashout", "Motorcycle", "StewartPlatform"]
RIDE = "extra/org.fmi-standard.fmi-ls-ref"
STEP = 0.01


def fmus(model):
    directory = TARGET / "fmu"
    paths = [directory / f"{model}.fmu", directory / f"{model}.fmi3.fmu"]
    for path in paths:
        assert path.exists(), f"{path} is missing: run `cargo build-fmu` and `cargo build-fmu --fmi 3`"
    return paths


def read(fmu, name):
    with zipfile.ZipFile(fmu) as archive:
        return archive.read(f"{RIDE}/{name}").decode()


@pytest.mark.parametrize("model", MODELS)
def test_names_value_references_and_start_values_are_those_of_fmi_2(model):
    def table(fmu):
        variables = read_model_description(fmu).modelVariables
        types = {"Real": "Float64", "Integer": "Int32"}
        return [
            (v.name, v.valueReference, types.get(v.type, v.type), v.causality, v.variability, v.start, v.min, v.max)
            + tuple(stated(v, attribute) for attribute in ("quantity", "unit", "displayUnit", "nominal"))
            for v in variables
        ]

    fmi2, fmi3 = map(table, fmus(model))
    assert fmi2 == fmi3
    assert len(fmi2) > 50


@pytest.mark.parametrize("model", MODELS)
def test_the_reference_ride_is_the_same_bit_for_bit_and_as_the_reference_says(model, tmp_path):
    fmi2, fmi3 = fmus(model)
    for name in (f"{model}_in.csv", f"{model}_ref.csv", f"{model}.exp"):
        assert read(fmi2, name) == read(fmi3, name)
    (tmp_path / "in.csv").write_text(read(fmi3, f"{model}_in.csv"))
    reference = np.genfromtxt(io.StringIO(read(fmi3, f"{model}_ref.csv")), delimiter=",", skip_header=1)
    names = read(fmi3, f"{model}_ref.csv").splitlines()[0].split(",")
    stop = reference[-1, 0]
    options = {"stop_time": stop, "output_interval": STEP, "output": names[1:], "input": read_csv(str(tmp_path / "in.csv"))}
    as_fmi2, as_fmi3 = (simulate_fmu(str(fmu), **options) for fmu in (fmi2, fmi3))
    rows2, rows3 = (np.column_stack([result[name] for name in names]) for result in (as_fmi2, as_fmi3))
    assert np.array_equal(rows2, rows3)
    rows = rows3[np.round(reference[1:, 0] / STEP).astype(int)]
    assert np.abs(rows - reference[1:]).max() < 1e-9
    assert np.ptp(rows3, axis=0).max() > 0.1
