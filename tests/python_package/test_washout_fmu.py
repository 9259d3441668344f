"""Another washout as an FMU, stepped and judged by the package."""

import re
import subprocess
import sys

import moris
import numpy as np
import pytest
from conftest import ROOT, gentle

MAP = ROOT / "examples" / "washout-map.toml"
NUMBERS = {"classical": 1, "predictive": 4}
POSE = ("platform.position", "platform.orientation", "actuator.length")


def written(path, text):
    path.write_text(text)
    return path


def changed(path, *changes):
    """The map of our washout with other text."""
    text = MAP.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return written(path, text)


@pytest.fixture(scope="module")
def dyadic():
    """A ride whose values and times are multiples of powers of 2, so that slopes are exact."""
    columns = gentle(12.0, 1 / 128)
    return moris.Recording({name: np.round(values * 2**20) / 2**20 for name, values in columns.items()}, fade_in=0.0)


@pytest.mark.parametrize("strategy", ["classical", "predictive"])
def test_our_fmu_is_the_simulation_to_the_bit(dyadic, fmu, tmp_path, strategy):
    own = moris.simulate(dyadic, strategy=strategy)
    judged = moris.measure(dyadic, washout=fmu, washout_map=changed(tmp_path / "map.toml", ("[start]", f"[start]\nstrategy = {NUMBERS[strategy]}")))
    for name in POSE[:2]:
        assert np.array_equal(own[name], judged[name]), name
    assert np.allclose(own["actuator.length"], judged["actuator.length"], rtol=0, atol=1e-12)
    assert "MorisWashout on default rig" in judged.name
    assert judged.fits is True and not any("do not change" in finding for finding in judged.findings)


def test_the_example_has_the_motion_of_the_script_in_the_page(tmp_path, monkeypatch):
    example = ["cargo", "run", "--quiet", "--manifest-path", ROOT / "Cargo.toml", "--bin", "moris-11_own_washout_as_fmu"]
    subprocess.run(example, cwd=tmp_path, check=True)
    subprocess.run([sys.executable, ROOT / "examples" / "recording.py", tmp_path / "ride.csv"], check=True)
    page = (ROOT / "docs" / "your-washout.md").read_text()
    script = next(text for text in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "poses.append" in text)
    monkeypatch.chdir(tmp_path)
    found = {}
    exec(script, found)  # noqa: S102
    washout_map = ROOT / "examples" / "11_own_washout_as_fmu" / "map.toml"
    twin = moris.measure(found["ride"], washout=tmp_path / "target" / "fmu" / "ReidNahon.fmu", washout_map=washout_map)
    for name in POSE:
        assert np.abs(found["mine"][name] - twin[name]).max() < 1e-9, name
    assert found["mine"]["platform.position"].std() > 1e-3


def test_units_and_signs_are_those_of_the_map(dyadic, fmu, tmp_path):
    own = moris.measure(dyadic, washout=fmu, washout_map=MAP)
    # Forces and rates of the felt motion, with a sign that is turned.
    outputs = "".join(
        f'{vector}{axis} = {{ at = "rider.{name}.{axis}" }}\n'
        for vector, name in (("a", "specificForce"), ("w", "angularVelocity"))
        for axis in "xyz"
    )
    text = MAP.read_text()
    felt = written(tmp_path / "felt.toml", text[: text.index("[outputs]")] + "[outputs]\n" + outputs)
    judged = moris.measure(dyadic, washout=fmu, washout_map=felt)
    close = {name: abs(value - judged.measures[name]) for name, value in own.measures.items() if name.endswith("RMS error")}
    assert max(close.values()) < 1e-4, close
    wrong = felt.read_text().replace('"rider.specificForce.y" }', '"rider.specificForce.y", scale = -1 }')
    findings = moris.measure(dyadic, washout=fmu, washout_map=written(tmp_path / "sign.toml", wrong)).findings
    assert any("Sway is felt with the wrong sign" in finding for finding in findings), findings
    small = felt.read_text()
    for axis in "xyz":
        small = small.replace(f'"rider.specificForce.{axis}" }}', f'"rider.specificForce.{axis}", scale = 0.1019716 }}')
    findings = moris.measure(dyadic, washout=fmu, washout_map=written(tmp_path / "g.toml", small)).findings
    assert any("9.8 times too small" in finding for finding in findings), findings


def test_other_rates_are_stepped_and_said(dyadic, fmu, tmp_path):
    fine = moris.measure(dyadic, washout=fmu, washout_map=changed(tmp_path / "fine.toml", ("[start]", "step = 0.0009765625\n[start]")))
    own = moris.measure(dyadic, washout=fmu, washout_map=MAP)
    assert np.abs(fine["platform.position"] - own["platform.position"]).max() < 1e-6
    other = moris.measure(dyadic, washout=fmu, washout_map=changed(tmp_path / "other.toml", ("[start]", "step = 0.01\n[start]")))
    assert any("interpolated linearly" in finding for finding in other.findings), other.findings
    assert np.abs(other["platform.position"] - own["platform.position"]).max() < 1e-3


def test_a_wrong_map_is_an_error_that_says_the_remedy(dyadic, fmu, tmp_path):
    force = '"vehicle.specificForce.x"'
    errors = {
        "is no input of the FMU; its inputs are": (force, '"platform.position.x"'),
        "surge is no input of the FMU; its inputs are": (force, '"surge"'),
        "is in m/s2 by the FMU, but in g by the map": (force, force + ', unit = "g"'),
        "unit furlong: write m/s2, g": (force, force + ', unit = "furlong"'),
        "as in mm": ('"platform.position.z"', '"platform.position.z", scale = 1000'),
        r"lacks yaw.*a constant is a number": ('yaw = { at = "platform.orientation.yaw" }', ""),
        "unknown field `name`": (force, force + ', name = "u"'),
        "an output is a number, or a table of at": ("\nx = { at =", "\nx = { of ="),
        "no variable leg.*its outputs are": ('"platform.position.x"', '"leg"'),
        "no variable 'engine'": ("[start]", "[start]\nengine = 1"),
    }
    for number, (words, change) in enumerate(errors.items()):
        wrong = changed(tmp_path / f"{number}.toml", change)
        with pytest.raises(moris.RecordingError, match=words):
            moris.measure(dyadic, washout=fmu, washout_map=wrong)
    with pytest.raises(TypeError, match="needs its washout_map"):
        moris.measure(dyadic, washout=fmu)
    disengaged = changed(tmp_path / "off.toml", ("[start]", "[start]\nengaged = 0"))
    assert any("outputs do not change" in finding for finding in moris.measure(dyadic, washout=fmu, washout_map=disengaged).findings)
