"""Sends the telemetry of a computed drive by UDP, as a game does: lines of the format csv of `moris-live`.

    python3 examples/vehicle.py [SECONDS] [PORT]

Sixty lines a second for 20 s, to port 4444 of this machine: a car that accelerates, brakes and turns.
"""

import socket
import sys
import time
from math import cos, sin

RATE = 60  # 1/s
GRAVITY = 9.80665


def line(t):
    """Time, specific force, angular velocity, roll, pitch, yaw and speed."""
    speed = 15.0 + 5.0 * sin(0.4 * t)
    yaw_rate = 0.15 * sin(0.7 * t)
    force = (5.0 * 0.4 * cos(0.4 * t), speed * yaw_rate, GRAVITY)
    yaw = -0.15 / 0.7 * cos(0.7 * t)
    return ",".join(f"{value:.6f}" for value in (t, *force, 0.0, 0.0, yaw_rate, 0.0, 0.0, yaw, speed))


def main(seconds=20.0, port=4444):
    vehicle = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    start = time.monotonic()
    for k in range(int(float(seconds) * RATE)):
        time.sleep(max(0.0, start + k / RATE - time.monotonic()))
        vehicle.sendto(line(k / RATE).encode(), ("127.0.0.1", int(port)))


if __name__ == "__main__":
    main(*sys.argv[1:])
