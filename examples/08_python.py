"""Simulates a recording with two presets in Python, and sweeps a break frequency.

    python3 examples/08_python.py

Needs the package: `pip install .` in the repository. Draws `target/examples/08_python.svg`.
"""

from pathlib import Path

import moris
from picture import BLUE, GREY, ORANGE, draw
from recording import main as write_recording

DIRECTORY = Path("target/examples/08_python")
SURGE = "specific force x RMS error"

write_recording(DIRECTORY / "ride.csv")
recording = moris.Recording(DIRECTORY / "ride.csv")

simulations = {name: moris.simulate(recording, parameters=name) for name in ("classical", "paper")}
for name, simulation in simulations.items():
    fits = "fits the rig" if simulation.fits else "does not fit the rig"
    print(f"{name}: RMS error of surge {simulation.measures[SURGE]:.3f} m/s², {fits}")

frequencies = [1.0, 2.0, 3.0, 4.0, 5.0]
sets = [{"splitter.x.omega1": frequency} for frequency in frequencies]
for result in moris.sweep(recording, sets, base="classical", progress=False).value:
    print(f"break frequency {frequencies[result.index]:.0f} rad/s: RMS error of surge {result[SURGE][0]:.3f} m/s²")

one, other = simulations.values()
draw("target/examples/08_python.svg", "One recording with two presets", one.time, [
    (f"specific force,\n{name} [m/s²]", [
        ("desired", one[f"vehicle.specificForce.{axis}"], GREY),
        ("felt, classical", one[f"rider.specificForce.{axis}"], BLUE),
        ("felt, paper", other[f"rider.specificForce.{axis}"], ORANGE),
    ])
    for name, axis in (("surge", "x"), ("sway", "y"))
])
