"""Rides five laps of the motorcycle's road with a preview that is learned, and draws the first and the last one.

    cargo build-fmu
    python3 examples/12_laps.py

Draws `target/examples/12_laps.svg`. Needs the package `moris`.
"""

import moris
import numpy as np
from fmpy import simulate_fmu
from picture import BLUE, GREY, draw

LAPS = 5
LENGTH = 1631.1  # m
STEP = 0.02  # s
PARAMETERS = ["preview", {"scale.angularVelocity.x": 0.1}]


def ride(fmu="target/fmu/Motorcycle.fmu", duration=480.0):
    """The laps as a recording with its position, and the distance covered [m]."""
    names = {
        f"{short}{axis}": f"vehicle.{vector}.{axis}"
        for short, vector in (("a", "specificForce"), ("w", "angularVelocity"))
        for axis in "xyz"
    }
    names |= {"x": "vehicle.position.x", "y": "vehicle.position.y", "speed": "vehicle.speed", "distance": "path.distance"}
    lap = {"path.course": 6}
    result = simulate_fmu(fmu, stop_time=duration, step_size=STEP, output_interval=STEP, start_values=lap, output=list(names.values()))
    recording = {short: np.asarray(result[name]) for short, name in ({"time": "time"} | names).items()}
    return recording, recording.pop("distance")


def main():
    recording, distance = ride()
    desired = [recording["ax"], recording["ay"]]
    simulation = moris.simulate(recording, parameters=PARAMETERS, learn=True)
    felt = [simulation[f"rider.specificForce.{axis}"] for axis in "xy"]
    laps = [np.searchsorted(distance, LENGTH * np.array([lap, lap + 1])) for lap in range(LAPS)]
    for lap, (begin, end) in enumerate(laps, 1):
        errors = [np.sqrt(np.mean((f - d)[begin:end] ** 2)) for f, d in zip(felt, desired)]
        print(f"lap {lap}: RMS error {errors[0]:.2f} m/s² in surge, {errors[1]:.3f} m/s² in sway")
    count = min(end - begin for begin, end in laps)

    def panel(lap, axis):
        shown = slice(laps[lap - 1][0], laps[lap - 1][0] + count)
        curves = [("desired", desired[axis][shown], GREY), ("felt", felt[axis][shown], BLUE)]
        return f"lap {lap}, {('surge', 'sway')[axis]}\n[m/s²]", curves

    panels = [panel(lap, axis) for axis in (0, 1) for lap in (1, LAPS)]
    draw("target/examples/12_laps.svg", "The first lap, and the last of five", recording["time"][:count], panels)


if __name__ == "__main__":
    main()
