"""Tunes the parameters on a recording, and compares the felt motion before and after.

    python3 examples/05_tune.py

`cargo moris tune` needs the recording and writes a parameter file. `cargo moris simulate` writes every output at every
sample. Draws `target/examples/05_tune.svg`.
"""

import subprocess
from pathlib import Path

import numpy as np
from picture import BLUE, GREY, ORANGE, draw
from recording import main as write_recording

try:
    import tomllib
except ImportError:  # Python 3.10
    import tomli as tomllib

DIRECTORY = Path("target/examples/05_tune")
RIG = ["--rig", "examples/rigs/narrow.toml"]


def moris(*arguments):
    subprocess.run(["cargo", "moris", *arguments, *RIG, "--report", DIRECTORY], check=True, stdout=subprocess.DEVNULL)


recording, tuned = DIRECTORY / "ride.csv", DIRECTORY / "tuned.toml"
write_recording(recording)
moris("tune", recording, "--evaluations", "150", "--output", tuned)
moris("simulate", recording, "--parameters", "default", "--compare", tuned)

before = np.genfromtxt(DIRECTORY / "ride.outputs.csv", delimiter=",", names=True, deletechars="")
after = np.genfromtxt(DIRECTORY / "ride.tuned.outputs.csv", delimiter=",", names=True, deletechars="")
for name, value in tomllib.loads(tuned.read_text()).items():
    print(f"{name} = {value}" if isinstance(value, str) else f"{name} = {value:.3g}")
draw("target/examples/05_tune.svg", "One recording with two parameter sets", before["time"], [
    (f"specific force,\n{name} [m/s²]", [
        ("desired", before[f"vehicle.specificForce.{axis}"], GREY),
        ("felt, default", before[f"rider.specificForce.{axis}"], ORANGE),
        ("felt, tuned", after[f"rider.specificForce.{axis}"], BLUE),
    ])
    for name, axis in (("surge", "x"), ("sway", "y"))
])
