"""Finds the scale with which a slalom is felt the right way round, and draws what is felt with it and at a scale of 1.

    python3 examples/13_scale.py

Draws `target/examples/13_scale.svg`. Needs the package `moris`.
"""

import moris
import numpy as np
from picture import BLUE, GREY, draw

STEP = 0.01  # s


def slalom(force=3.0, frequency=0.15, duration=40.0):
    """Sway of this amplitude [m/s2], from rest and back to it."""
    time = np.arange(0.0, duration, STEP)
    envelope = np.minimum(1.0, np.minimum(time, duration - time) / 3.0)
    ay = force * envelope * np.sin(2 * np.pi * frequency * time)
    return time, ay


def main():
    time, desired = slalom()
    recording = moris.Recording({"time": time, "ax": 0 * time, "ay": desired}, missing="rest")
    fit = moris.fit(recording)
    scales = [1.0, fit.best.scale]
    sets = [{f"scale.specificForce.{axis}": scale for axis in "xy"} for scale in scales]
    panels = []
    for scale, parameters in zip(scales, sets):
        simulation = moris.simulate(recording, parameters=parameters)
        shape, size, inverted = (simulation.measures[f"specific force y {name}"] for name in ("shape", "size", "inverted"))
        print(f"scale {scale:.2f}: shape {shape:.2f}, size {size:.2f}, inverted {inverted:.1f} % of the time")
        curves = [("desired", desired, GREY), ("felt", simulation["rider.specificForce.y"], BLUE)]
        panels.append((f"scale {scale:.2f}\nsway [m/s²]", curves))
    draw("target/examples/13_scale.svg", "A slalom at a scale of 1, and at the one that fits", time, panels)


if __name__ == "__main__":
    main()
