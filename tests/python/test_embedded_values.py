"""FMUs with embedded start values of a rig and parameters: what they start with, and that it is the same as setting them."""

import subprocess
import zipfile

import numpy as np
import pytest
from conftest import ROOT
from fmpy import read_model_description, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

RIG = ROOT / "examples" / "rigs" / "narrow.toml"
LEGS = [f"actuator[{i}].length" for i in range(1, 7)]


@pytest.fixture(scope="module")
def embedded(tmp_path_factory):
    """The washout's FMUs of FMI 2.0, 3.0 and 3.0 with arrays on another rig, with the parameters of the set paper."""
    output = tmp_path_factory.mktemp("Büro — モーション %20 1")
    for version in (["2,3"], ["3", "--arrays"]):
        command = ["cargo", "build-fmu", "--model", "MorisWashout", "--output", output, "--fmi", *version]
        subprocess.run([*command, "--rig", RIG, "--parameters", "paper"], cwd=ROOT, check=True)
    return [output / f"MorisWashout.{kind}" for kind in ("fmu", "fmi3.fmu", "fmi3.arrays.fmu")]


def starts(fmu):
    """The start value of every input and parameter, by name."""
    return {v.name: v.start for v in read_model_description(fmu).modelVariables if v.start is not None}


def simulate(fmu, lengths, start_values=None):
    """The actuators' lengths after each of 500 steps of 1 ms with an acceleration that is there from the beginning."""
    result = simulate_fmu(fmu, stop_time=0.5, step_size=0.001, output_interval=0.001, start_values=start_values or {}, output=lengths)
    return np.column_stack([result[name] for name in lengths])


def test_the_descriptions_have_the_values_and_are_valid(embedded):
    for fmu in embedded:
        assert validate_fmu(fmu) == []
    fmi2, fmi3 = map(starts, embedded[:2])
    assert float(fmi2["rig.neutralHeight"]) == float(fmi3["rig.neutralHeight"]) == 1.02
    assert float(fmi2["rig.platform[1].z"]) == 0.05
    assert [float(fmi2[f"splitter.{axis}.omega1"]) for axis in "xyz"] == [2.5, 2.5, 2.5]
    assert {name: float(v) for name, v in fmi3.items() if "." in name and "omega" in name} == {
        name: float(v) for name, v in fmi2.items() if "." in name and "omega" in name
    }


def test_embedded_values_are_as_good_as_values_that_are_set(embedded, fmu):
    own, others = starts(fmu), starts(embedded[0])
    others = {name: value for name, value in others.items() if value != own[name]}
    assert len(others) > 40
    moving = {"vehicle.specificForce.x": 1.0}
    expected = simulate(fmu, LEGS, others | moving)
    assert (simulate(embedded[0], LEGS, moving) == expected).all()
    assert np.ptp(expected, axis=0).min() > 1e-4
    assert (simulate(embedded[1], LEGS, moving) == expected).all()


def reference(fmu, end, folder):
    """A table of the FMU's reference ride."""
    file = folder / f"{end}.csv"
    with zipfile.ZipFile(fmu) as archive:
        file.write_bytes(archive.read(f"extra/org.fmi-standard.fmi-ls-ref/MorisWashout_{end}.csv"))
    return read_csv(str(file))


def test_the_reference_ride_is_that_of_values_that_are_set_to_the_bit(embedded, fmu, tmp_path):
    ride, expected = (reference(embedded[0], end, tmp_path) for end in ("in", "ref"))
    own = starts(fmu)
    others = {name: value for name, value in starts(embedded[0]).items() if value != own[name]}
    options = {"stop_time": 10, "output_interval": 0.01, "input": ride, "output": list(expected.dtype.names[1:])}
    set_values = simulate_fmu(str(fmu), start_values=others, **options)
    for path in embedded[:2]:
        assert (simulate_fmu(str(path), **options) == set_values).all()
    rows = np.round(expected["time"] / 0.01).astype(int)[1:]
    assert max(np.abs(set_values[name][rows] - expected[name][1:]).max() for name in options["output"]) < 1e-9
    assert max(np.ptp(set_values[name]) for name in options["output"]) > 0.1
    # FMPy takes inputs of one shape only.
    force = ["vehicle.specificForce.x", "vehicle.specificForce.y", "vehicle.specificForce.z"]
    shape = [("time", float), ("vehicle.specificForce", float, (3,))]
    array = np.array([(row["time"], [row[name] for name in force]) for row in ride], dtype=shape)
    options |= {"input": ride[["time", *force]], "output": LEGS}
    scalars = simulate_fmu(str(embedded[0]), **options)
    arrays = simulate_fmu(str(embedded[2]), **(options | {"input": array, "output": ["actuator.length"]}))
    assert (arrays["actuator.length"] == np.column_stack([scalars[name] for name in LEGS])).all()
    assert np.ptp(arrays["actuator.length"], axis=0).min() > 1e-3


def test_every_set_of_values_has_a_guid_of_its_own(embedded, fmu):
    guids = {read_model_description(path).guid for path in (fmu, embedded[0])}
    assert len(guids) == 2


@pytest.mark.parametrize(
    "values, reason",
    [
        ("actuator.minLength = 1.7", "must be below actuator.maxLength"),
        ("spliter.x.omega1 = 1.0", "did you mean splitter.x.omega1"),
    ],
)
def test_what_cannot_be_started_with_is_not_built(tmp_path, values, reason):
    parameters = tmp_path / "mine.toml"
    parameters.write_text(values)
    command = ["cargo", "build-fmu", "--model", "MorisWashout", "--output", tmp_path, "--parameters", parameters]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode != 0 and reason in done.stderr
    assert not list(tmp_path.glob("*.fmu"))
