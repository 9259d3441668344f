"""`moris live` with the motorcycle's FMU as its vehicle, of both versions of FMI."""

import json
import os
import signal
import subprocess
import threading
import time
import urllib.request
from pathlib import Path

import pytest
from conftest import ROOT, TARGET

FMUS = Path(os.environ.get("MORIS_FMUS", TARGET / "fmu"))
MAP = ROOT / "examples" / "motorcycle-map.toml"
RIDDEN_MAP = ROOT / "examples" / "ridden-map.toml"
CARGO = ["cargo", "run", "--quiet", "--bin", "moris-live", "--"]


def start(version, vehicle_map, *options):
    """The command with the FMU of this version. It ends by itself, so that no test waits for ever."""
    live = [os.environ["MORIS"], "live"] if "MORIS" in os.environ else CARGO
    command = [*live, "--from", f"fmu:{FMUS / f'Motorcycle.{version}'}", "--map", vehicle_map]
    command += ["--frames", "json", "--dry", "--engage", "--for", "60", *options]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)


def lines_of(stream):
    """The lines of a stream, as they come: the command never waits for a reader."""
    lines = []

    def read():
        for text in stream:
            lines.append(text)

    threading.Thread(target=read, daemon=True).start()
    return lines


def end(process):
    """A second interrupt, half a second after the first, ends at once."""
    for _ in range(2):
        process.send_signal(signal.SIGINT)
        time.sleep(0.6)


@pytest.mark.parametrize("version", ["fmu", "fmi3.fmu"])
def test_the_motorcycle_drives_once_the_platform_engages(version):
    process = start(version, MAP)
    said = lines_of(process.stderr)
    surge = []
    # As long as this machine takes: the command ends after 60 s of the platform's time.
    for text in process.stdout:
        if text.startswith('{"time"'):
            surge.append(json.loads(text)["force"][0])
        if surge and surge[-1] > 0.1:
            break
    assert surge and surge[-1] > 0.1, (max(surge, default=None), said)
    threading.Thread(target=end, args=(process,)).start()
    out = process.stdout.read()
    assert process.wait() == 0, said
    # At rest until it engages, then the motorcycle pulls away.
    assert max(map(abs, surge[:25])) < 1e-6
    assert any(text.rstrip().endswith("engaging") for text in said), said
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
    end(process)
    process.communicate()
    assert process.returncode == 0
