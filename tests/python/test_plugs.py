"""A short ride between an emulated vehicle and an emulated controller in which each plug is pulled once."""

import subprocess
import sys

from conftest import ROOT


def test_every_plug_can_be_pulled():
    out = subprocess.run([sys.executable, ROOT / "tests" / "live" / "plugs.py"], capture_output=True, text=True, timeout=300)
    assert out.returncode == 0, out.stdout + out.stderr
    assert out.stdout.count(" frames; last ") == 18 and "kill -9: " in out.stdout, out.stdout
