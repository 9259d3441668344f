"""Simulates a computed recording with two parameter sets in Python, and sweeps a break frequency.

    python3 examples/08_python.py

Needs the package (`pip install .[plot]`). Draws `target/examples/08_python.svg`.
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import moris
from recording import main as write_recording

DIRECTORY = Path("target/examples")
SURGE = "specific force x RMS error"

write_recording(DIRECTORY / "08_python.csv")
recording = moris.Recording(DIRECTORY / "08_python.csv", name="computed ride")

for name in ("default", "paper"):
    simulation = moris.simulate(recording, parameters=name)
    print(f"{name:8} surge error {simulation.measures[SURGE]:.3f} m/s², {'fits' if simulation.fits else 'does not fit'}")

frequencies = [1.0, 2.0, 3.0, 4.0, 5.0]
sets = [{"splitter.x.omega1": frequency} for frequency in frequencies]
for frequency, result in zip(frequencies, moris.sweep(recording, sets, progress=False).value):
    print(f"break frequency {frequency:.0f} rad/s: surge error {result[SURGE][0]:.3f} m/s²")

matplotlib.rcParams.update({"svg.hashsalt": "moris", "svg.fonttype": "none"})
picture = DIRECTORY / "08_python.svg"
figure = moris.simulate(recording).plot()
figure.savefig(picture, metadata={"Date": None})
print(f"wrote {picture}")
