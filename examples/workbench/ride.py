"""Writes a made-up ride for the workbench, as a recorder at a rider's head would: python3 examples/workbench/ride.py ride.csv

Forty seconds at 100 Hz: pull away, swing through a slalom, brake to a stop. In the slalom the motorcycle leans so that the
specific force stays along the rider's spine: what he feels of it is his weight, the roll and the yaw.
"""

import csv
import sys
from math import atan, cos, pi, sin, sqrt

STEP = 0.01
GRAVITY = 9.80665


def rise(t, start, duration):
    """Smoothly from 0 to 1."""
    x = min(max((t - start) / duration, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def speed(t):
    """Integrated numerically from the acceleration along the road."""
    steps = int(t / (10 * STEP))
    return sum(along(k * 10 * STEP) * 10 * STEP for k in range(steps))


def along(t):
    """Acceleration along the road [m/s2]."""
    return 1.8 * (rise(t, 2.0, 2.0) - rise(t, 9.0, 2.0)) - 2.5 * (rise(t, 29.0, 1.5) - rise(t, 34.04, 1.5))


def sideways(t):
    """Centripetal acceleration of the slalom [m/s2]."""
    return 2.5 * sin(2 * pi * 0.25 * (t - 14.0)) * (rise(t, 13.0, 2.0) - rise(t, 24.0, 2.0))


def lean(t):
    """To the right [rad]: what balances the centripetal acceleration, which is positive to the left."""
    return -atan(sideways(t) / GRAVITY)


def main():
    with open(sys.argv[1], "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["time", "ax", "ay", "az", "wx", "wy", "wz"])
        for k in range(4001):
            t = k * STEP
            roll = lean(t)
            yaw_rate = sideways(t) / max(speed(t), 3.0)
            row = [
                along(t),
                0.0,
                sqrt(GRAVITY**2 + sideways(t) ** 2),
                (lean(t + STEP) - lean(t - STEP)) / (2 * STEP),
                sin(roll) * yaw_rate,
                cos(roll) * yaw_rate,
            ]
            table.writerow([f"{t:.2f}"] + [f"{value:.5f}" for value in row])


if __name__ == "__main__":
    main()
