"""`moris live` with the motorcycle's FMU as its vehicle, of both versions of FMI."""

import json
import os
import signal
import subprocess
import time
import urllib.request
from pathlib import Path

import pytest
from conftest import ROOT

FMUS = Path(os.environ.get("MORIS_FMUS", ROOT / "target" / "fmu"))
MAP = ROOT / "examples" / "motorcycle-map.toml"
RIDDEN_MAP = ROOT / "examples" / "ridden-map.toml"
CARGO = ["cargo", "run", "--quiet", "--bin", "moris", "--"]


def start(version, vehicle_map, *options):
    """The command with the FMU of this version. It ends by itself, so that no test waits for ever."""
    moris = [os.environ["MORIS"]] if "MORIS" in os.environ else CARGO
    command = [*moris, "live", "--from", f"fmu:{FMUS / f'Motorcycle.{version}'}", "--map", vehicle_map]
    command += ["--frames", "json", "--dry", "--engage", "--for", "60", *options]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)


@pytest.mark.parametrize("version", ["fmu", "fmi3.fmu"])
def test_the_motorcycle_drives_once_the_platform_engages(version):
    process = start(version, MAP)
    said = []
    for text in process.stderr:
        said.append(text)
        if text.rstrip().endswith("engaging"):
            break
    assert said and said[-1].rstrip().endswith("engaging"), said
    time.sleep(3)
    # A second interrupt, half a second later, ends at once.
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.6)
    out, _ = process.communicate()
    assert process.returncode == 0, said
    frames = [json.loads(text) for text in out.splitlines() if text.startswith('{"time"')]
    # At rest until it engages, then the motorcycle pulls away.
    surge = [frame["force"][0] for frame in frames]
    assert max(map(abs, surge[:25])) < 1e-6
    assert max(surge) > 0.1, max(surge)
    assert "0 bad" in out, out


@pytest.mark.parametrize("version", ["fmu", "fmi3.fmu"])
def test_the_page_holds_the_inputs_of_an_fmu(version):
    process = start(version, RIDDEN_MAP, "--page")
    address = next(said.removeprefix("page: ").strip() for said in process.stderr if said.startswith("page: "))
    own, token = address.split("/?token=")

    def messages(events):
        return (json.loads(text.removeprefix(b"data: ")) for text in events if text.startswith(b"data: "))

    def drive(throttle, stick):
        held = {"throttle": throttle, "brake": 0, "stick": stick, "is_helped": False}
        body = json.dumps({"client": welcome["client"], "ask": {"drive": held}}).encode()
        request = urllib.request.Request(f"{own}/ask", body, {"X-Token": token, "Origin": own})
        urllib.request.urlopen(request).close()

    with urllib.request.urlopen(f"{own}/events?token={token}") as events:
        received = messages(events)
        welcome = next(received)
        assert welcome["drives"]
        speed, roll = (welcome["names"].index(name) for name in ("speed", "roll"))
        rows = (message["rows"][-1] for message in received if message.get("rows"))
        # A lean to the right is a positive roll.
        for row in rows:
            assert row[0] < 50, row
            drive(0.6, 0.3 if row[speed] > 5 else 0)
            if row[roll] > 0.1:
                break
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.6)
    process.communicate()
    assert process.returncode == 0
