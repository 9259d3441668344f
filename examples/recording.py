"""Writes a computed recording as a CSV file, as a logger at a rider's head would.

    python3 examples/recording.py ride.csv [SCALE]

Forty seconds at 100 Hz: a motorcycle pulls away, rides a slalom and brakes to a stop. SCALE multiplies its
accelerations, 1 by default. In the slalom the motorcycle leans so that the specific force points along the rider's
spine.
"""

import csv
import sys
from math import atan, cos, pi, sin, sqrt
from pathlib import Path

STEP = 0.01  # s
GRAVITY = 9.80665


def rise(t, start, duration):
    """A smooth step from 0 to 1."""
    x = min(max((t - start) / duration, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def along(t):
    """Acceleration along the road [m/s²]."""
    return 1.8 * (rise(t, 2.0, 2.0) - rise(t, 9.0, 2.0)) - 2.5 * (rise(t, 29.0, 1.5) - rise(t, 34.04, 1.5))


def sideways(t):
    """Centripetal acceleration of the slalom, positive to the left [m/s²]."""
    return 2.5 * sin(2 * pi * 0.25 * (t - 14.0)) * (rise(t, 13.0, 2.0) - rise(t, 24.0, 2.0))


def lean(t, scale):
    """Roll angle that balances the centripetal acceleration, positive to the right [rad]."""
    return -atan(scale * sideways(t) / GRAVITY)


def main(path, scale=1.0):
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["time", "ax", "ay", "az", "wx", "wy", "wz"])
        speed = 0.0
        for k in range(4001):
            t = k * STEP
            roll, across = lean(t, scale), scale * sideways(t)
            roll_rate = (lean(t + STEP, scale) - lean(t - STEP, scale)) / (2 * STEP)
            yaw_rate = across / max(speed, 3.0)
            force = [scale * along(t), 0.0, sqrt(GRAVITY**2 + across**2)]
            rates = [roll_rate, sin(roll) * yaw_rate, cos(roll) * yaw_rate]
            table.writerow([f"{t:.2f}", *(f"{value:.5f}" for value in force + rates)])
            speed += scale * along(t) * STEP


if __name__ == "__main__":
    main(sys.argv[1], *map(float, sys.argv[2:]))
