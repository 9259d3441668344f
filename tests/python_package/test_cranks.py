"""Cranks: the FMU of a rig file, and the angles that other programs compute."""

import importlib
from contextlib import redirect_stdout

import moris
import numpy as np
import pytest
from conftest import ROOT, gentle

RIGS = ["crank-servo", "crank-hobby20", "crank-hobby25", "crank-stepper50", "crank-person"]


@pytest.fixture
def example(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    return importlib.import_module("15_servo_angles")


def test_angles_are_those_of_the_usual_formula(example):
    example.write_recording(example.DIRECTORY / "ride.csv")
    for rig in RIGS:
        poses, (least, most), difference = example.compared(rig)
        assert poses == 4001 and most - least > np.radians(5) and difference < 1e-12, rig


@pytest.mark.parametrize("rig", ["crank-servo", "crank-person"])
def test_an_own_fmu_of_a_rig_file_commands_arms_whose_rods_fit(example, fmu, rig, tmp_path):
    fmpy = pytest.importorskip("fmpy", reason="needs FMPy: pip install fmpy")
    own = moris.build_fmu(rig=ROOT / "examples" / "rigs" / f"{rig}.toml", base=fmu, output=tmp_path)
    ride = gentle(12.0)
    inputs = np.rec.fromarrays([ride["time"], ride["ax"], ride["ay"]], names=["time", "vehicle.specificForce.x", "vehicle.specificForce.y"])
    position = [f"platform.position.{axis}" for axis in "xyz"]
    turn = [f"platform.orientation.{axis}" for axis in ("roll", "pitch", "yaw")]
    angles = [f"actuator[{crank}].angle" for crank in range(1, 7)]
    rates = [f"actuator[{crank}].angularVelocity" for crank in range(1, 7)]
    with redirect_stdout(None):
        result = fmpy.simulate_fmu(str(own), input=inputs, output=position + turn + angles + rates, stop_time=12, output_interval=0.01)
    values = {variable.name: variable.start for variable in fmpy.read_model_description(str(own)).modelVariables}
    values = {name: float(start) for name, start in values.items() if name.startswith(("crank.", "rig."))}
    p, angle, rate = (np.column_stack([result[name] for name in names]) for names in (position, angles, rates))
    rotation = example.rotations(*(result[name] for name in turn))
    arm, rod = values["crank.arm"], values["crank.rod"]
    for crank in range(1, 7):
        axle, joint = (np.array([values[f"rig.{part}[{crank}].{axis}"] for axis in "xyz"]) for part in ("base", "platform"))
        heading, at = values[f"crank.heading[{crank}]"], angle[:, crank - 1]
        out = np.column_stack([np.cos(at) * np.cos(heading), np.cos(at) * np.sin(heading), np.sin(at)])
        rods = np.linalg.norm(p + rotation @ joint - axle - arm * out, axis=1)
        assert np.abs(rods - rod).max() < 1e-9
        assert np.ptp(at) > np.radians(1) and values["crank.minAngle"] < at.min() and at.max() < values["crank.maxAngle"]
        # Rates are the derivatives of the angles.
        differences = (at[2:] - at[:-2]) / 0.02
        assert np.abs(differences - rate[1:-1, crank - 1]).max() < 0.02 * np.abs(rate[:, crank - 1]).max() + 1e-4
    assert np.abs(angle - example.servo_angles(values, p, rotation)).max() < 1e-9
