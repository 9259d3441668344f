"""Compares the angles of cranks with the formula that programs for servo platforms use, on the shipped rigs.

    python3 examples/15_servo_angles.py

Simulates a ride on each rig, and computes the servo angles of its poses by

    L = |l|^2 - s^2 + a^2,  M = 2 a l_z,  N = 2 a (l_x cos b + l_y sin b),  angle = asin(L / sqrt(M^2 + N^2)) - atan2(N, M)

with l from axle to joint, the arm a, the rod s and the arm's heading b. Needs the package `moris` and NumPy.
"""

from pathlib import Path

import moris
import numpy as np
from recording import main as write_recording

DIRECTORY = Path("target/examples/15_servo_angles")
RIGS = ["crank-servo", "crank-hobby20", "crank-hobby25", "crank-stepper50", "crank-person"]


def rotations(roll, pitch, yaw):
    """Rotation matrices (N, 3, 3) of Rz(yaw) Ry(pitch) Rx(roll)."""
    (sr, sp, sy), (cr, cp, cy) = np.sin([roll, pitch, yaw]), np.cos([roll, pitch, yaw])
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def servo_angles(rig, positions, rotation):
    """Angles (N, 6) of the arms in these poses [rad], with the rig's parameters by name."""
    arm, rod = rig["crank.arm"], rig["crank.rod"]
    angles = []
    for servo in range(1, 7):
        axle, joint = ([rig[f"rig.{part}[{servo}].{axis}"] for axis in "xyz"] for part in ("base", "platform"))
        x, y, z = (positions + rotation @ joint - axle).T
        heading = rig[f"crank.heading[{servo}]"]
        left = x * x + y * y + z * z - rod**2 + arm**2
        m, n = 2 * arm * z, 2 * arm * (x * np.cos(heading) + y * np.sin(heading))
        angles.append(np.arcsin(left / np.hypot(m, n)) - np.arctan2(n, m))
    return np.column_stack(angles)


def compared(rig):
    """Number of poses, range of the angles [rad], and the largest difference from the formula [rad]."""
    ride = moris.simulate(DIRECTORY / "ride.csv", rig=rig)
    rotation = rotations(*ride["platform.orientation"].T)
    expected = servo_angles(ride.parameters, ride["platform.position"], rotation)
    angles = ride["actuator.angle"]
    return len(angles), (angles.min(), angles.max()), np.abs(angles - expected).max()


def main():
    write_recording(DIRECTORY / "ride.csv")
    for rig in RIGS:
        poses, (least, most), difference = compared(rig)
        least, most = np.degrees([least, most])
        agreement = "equal to 1e-12 rad" if difference < 1e-12 else f"off by {difference:.1e} rad"
        print(f"{rig}: {poses} poses, arms at {least:.0f} to {most:.0f} degrees, {agreement}")


if __name__ == "__main__":
    main()
