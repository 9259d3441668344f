"""Shared by the tests of the Python package: computed recordings, and the FMU to compare with."""

import os
import shutil
import signal
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
STANDARD_GRAVITY = 9.80665
only_all_cases = pytest.mark.skipif("MORIS_ALL_CASES" not in os.environ, reason="one of all cases: with --all")
"""For what few changes can break, and what takes long: memory, and other people's schedulers."""

# A shell starts what runs in its background with Ctrl-C ignored; tests that raise it need Python's own handler.
signal.signal(signal.SIGINT, signal.default_int_handler)


def smooth(x):
    """x^2 (3 - 2x) between 0 and 1."""
    x = np.clip(x, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)


def gentle(duration=20.0, step=0.01):
    """A ride that accelerates, sways and brakes within what the default rig can do."""
    time = np.arange(round(duration / step) + 1) * step
    surge = 0.8 * (smooth(time / 4 - 0.5) - smooth(time / 4 - 2.5)) - 0.6 * smooth(time / 3 - 4.5)
    fade = smooth(time / 2)
    sway = 0.5 * fade * np.sin(0.8 * time)
    roll_rate = 0.05 * fade * np.cos(0.6 * time)
    return {
        "time": time,
        "ax": surge,
        "ay": sway,
        "az": STANDARD_GRAVITY + 0.1 * fade * np.sin(2.0 * time),
        "wx": roll_rate,
        "wy": 0.02 * fade * np.sin(0.5 * time),
        "wz": 0.1 * fade * np.sin(0.3 * time),
    }


@pytest.fixture
def ride():
    return gentle()


@pytest.fixture(scope="session")
def rides():
    """Three rides that differ in length and strength."""
    made = []
    for number, (duration, factor) in enumerate([(12.0, 1.0), (15.0, 0.7), (10.0, 1.2)]):
        columns = gentle(duration)
        for name in ("ax", "ay", "wx", "wy", "wz"):
            columns[name] = factor * columns[name]
        made.append((f"ride {number}", columns))
    return made


@pytest.fixture(scope="session")
def fmu():
    path = Path(os.environ.get("MORIS_FMU", TARGET / "fmu" / "MorisWashout.fmu"))
    assert path.exists(), f"{path} is missing: run `cargo build-fmu`"
    return path


@pytest.fixture(scope="session")
def unpacked(fmu):
    from fmpy import extract

    directory = extract(str(fmu))
    yield directory
    shutil.rmtree(directory, ignore_errors=True)
