"""`moris live` with the motorcycle's FMU as its vehicle, of both versions of FMI."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import ROOT

FMUS = Path(os.environ.get("MORIS_FMUS", ROOT / "target" / "fmu"))
MAP = ROOT / "examples" / "motorcycle-map.toml"
CARGO = ["cargo", "run", "--quiet", "--bin", "moris", "--"]


@pytest.mark.parametrize("version", ["fmu", "fmi3.fmu"])
def test_the_motorcycle_drives_once_the_platform_engages(version):
    moris = [os.environ["MORIS"]] if "MORIS" in os.environ else CARGO
    command = [*moris, "live", "--from", f"fmu:{FMUS / f'Motorcycle.{version}'}", "--map", MAP]
    # It ends by itself, so that no test waits for ever.
    command += ["--frames", "json", "--dry", "--engage", "--for", "60"]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
    said = []
    for text in process.stderr:
        said.append(text)
        if text.rstrip().endswith("engaging"):
            break
    assert said and said[-1].rstrip().endswith("engaging"), said
    time.sleep(3)
    # A second interrupt ends at once.
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
    out, _ = process.communicate()
    assert process.returncode == 0, said
    frames = [json.loads(text) for text in out.splitlines() if text.startswith('{"time"')]
    # At rest until it engages, then the motorcycle pulls away.
    surge = [frame["force"][0] for frame in frames]
    assert max(map(abs, surge[:30])) < 1e-6
    assert max(surge) > 0.1, max(surge)
    assert "0 bad" in out, out
