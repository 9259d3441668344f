"""A short ride between an emulated vehicle and an emulated controller in which each plug is pulled once."""

import subprocess
import sys

import pytest
from conftest import ROOT

NO_REAL_TIME = 77
"""The script's exit status where the machine was too busy to judge a ride in real time."""


def test_every_plug_can_be_pulled():
    pytest.importorskip("tomllib", reason="needs tomllib: run the tests with Python 3.11 or newer")
    out = subprocess.run([sys.executable, ROOT / "tests" / "live" / "plugs.py"], capture_output=True, text=True, timeout=300)
    if out.returncode == NO_REAL_TIME:
        pytest.skip(out.stdout.splitlines()[-1])
    assert out.returncode == 0, out.stdout + out.stderr
    assert out.stdout.count(" frames; last ") == 19 and "kill -9: " in out.stdout, out.stdout
