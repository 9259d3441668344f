"""The washouts of the literature that the bench compares."""

import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT


@pytest.fixture(scope="module")
def washouts():
    sys.path.insert(0, str(ROOT / "examples"))
    import washouts

    return washouts


def test_reid_nahon_is_that_of_the_page(washouts, tmp_path, monkeypatch):
    subprocess.run([sys.executable, ROOT / "examples" / "recording.py", tmp_path / "ride.csv"], check=True)
    page = (ROOT / "docs" / "your-washout.md").read_text()
    script = next(text for text in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "poses.append" in text)
    monkeypatch.chdir(tmp_path)
    found = {}
    exec(script, found)  # noqa: S102
    ride = found["ride"]
    force = 0.5 * (ride.inputs["vehicle.specificForce"] - [0.0, 0.0, washouts.G])
    rate = 0.5 * ride.inputs["vehicle.angularVelocity"]
    poses = washouts.reid_nahon(force[:, :, None], rate[:, :, None])[:, :, 0]
    assert np.abs(poses - found["poses"]).max() < 1e-12


def test_the_linear_mpc_tilts_for_a_lasting_force_and_keeps_its_limits(washouts):
    # Rides of 20 s: a lasting force, none, and a swing beyond all limits.
    time = np.arange(0.0, 20.0, washouts.STEP)
    force = np.column_stack([np.full_like(time, 0.6), 0 * time, 20.0 * np.sin(0.8 * time)])
    limit = np.full(3, 0.15)
    travel, tilt = washouts.linear_mpc(force, limit, limit, 1.0)
    assert abs(washouts.G * tilt[-1, 0] - 0.6) < 0.1 and abs(travel[-1, 0]) < 0.03, (tilt[-1], travel[-1])
    assert not travel[:, 1].any() and not tilt[:, 1].any()
    assert np.abs(travel).max() < 1.2 * 0.15 and np.abs(tilt).max() < 1.2 * 0.15
    assert np.abs(np.diff(tilt, axis=0)).max() < 1.5 * washouts.TILT_RATE * washouts.STEP
    assert np.abs(travel[:, 2]).max() > 0.05
