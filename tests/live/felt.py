"""The force that the frames on the wire let a rider feel, by the rig's geometry.

The lengths, or the rods from the ends of the arms, give the platform's pose by Newton's method. The poses give the head's
acceleration by second differences, and the attitude gravity's part. Frames of 10 ms with lengths in um make an error of about 0.01 m/s2, so that nothing needs smoothing.
"""

import numpy as np
from rig import RIG, machine

GRAVITY = 9.80665
# Time within which a jolt is a change of the felt force [s].
SPAN = 0.02
# Time without frames from which on a controller's legs stand [s].
STANDS = 0.05


def joints(table):
    if "joints" in table:
        return np.array(table["joints"])
    angles = np.radians(table["degrees"])
    return table["radius"] * np.stack([np.cos(angles), np.sin(angles), np.zeros(6)], axis=1)


MACHINE, _, _ = machine(RIG)
BASE, PLATFORM = joints(MACHINE["base"]), joints(MACHINE["platform"])
# The rider's head above the platform's joints [m].
HEAD = np.array([0.0, 0.0, MACHINE["head"]["height"]])


def rods(lengths):
    """Foot and length of what leads to the platform: the legs, or the rods of arms at these arcs."""
    if "crank" not in MACHINE:
        return BASE, lengths
    crank = MACHINE["crank"]
    heading, angles = np.radians(crank["headingDegrees"]), lengths / crank["arm"]
    across = np.cos(angles)
    arms = np.stack([across * np.cos(heading), across * np.sin(heading), np.sin(angles)], axis=2)
    return BASE + crank["arm"] * arms, np.full_like(lengths, crank["rod"])


def rotations(angles):
    """Rotations of rolls, pitches and yaws."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles).T, np.cos(angles).T
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def poses(lengths, guesses):
    """Positions and rotations of the platform with these lengths, near guesses of x, y, z, roll, pitch and yaw."""
    position, rotation = guesses[:, :3].copy(), rotations(guesses[:, 3:])
    feet, lengths = rods(lengths)
    for _ in range(8):
        arms = np.einsum("nij,kj->nki", rotation, PLATFORM)
        legs = position[:, None] + arms - feet
        found = np.linalg.norm(legs, axis=2)
        along = legs / found[:, :, None]
        rows = np.concatenate([along, np.cross(arms, along)], axis=2)
        change = np.linalg.solve(rows, (lengths - found)[:, :, None])[:, :, 0]
        position += change[:, :3]
        angle = np.linalg.norm(change[:, 3:], axis=1)[:, None]
        x, y, z = (change[:, 3:] / np.maximum(angle, 1e-300)).T
        zero = np.zeros_like(x)
        axis = np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), 2, 0)
        angle = angle[:, :, None]
        rotation = (np.eye(3) + np.sin(angle) * axis + (1 - np.cos(angle)) * axis @ axis) @ rotation
        if np.abs(change).max() < 1e-10:
            return position, rotation
    raise AssertionError("lengths of no pose")


def felt(times, numbers, arrivals, interval):
    """Times and felt forces of frames, in parts without a gap in which a controller's legs stand: each begins at rest."""
    times, numbers, arrivals = map(np.asarray, (times, numbers, arrivals))
    position, rotation = poses(numbers[:, :6], numbers[:, 12:18])
    head = position + rotation @ HEAD
    for part in np.split(np.arange(len(times)), np.flatnonzero(np.diff(arrivals) > STANDS) + 1):
        ways, steps = np.diff(head[part], axis=0), np.diff(times[part])
        ways, steps = np.vstack([np.zeros(3), ways]), np.append(interval, steps)
        # A frame that follows a lost one goes on in the frames' times, or in their order: the smoother one counts.
        for k in range(1, len(ways)):
            last = ways[k - 1] / steps[k - 1]
            steps[k] = min((max(steps[k], 1e-9), interval), key=lambda step: np.linalg.norm(ways[k] / step - last))
        accelerations = 2 * np.diff(ways / steps[:, None], axis=0) / (steps[1:] + steps[:-1])[:, None]
        forces = np.einsum("nji,nj->ni", rotation[part[:-1]], accelerations + [0, 0, GRAVITY])
        rest = rotation[part[0]].T @ [0, 0, GRAVITY]
        yield times[part], np.vstack([rest, forces])


def jolts(times, numbers, arrivals, interval):
    """Largest change of the felt force's axes within SPAN until each frame, with the frame's time [m/s2, s]."""
    found = []
    for at, forces in felt(times, numbers, arrivals, interval):
        for step in range(1, round(SPAN / interval) + 1):
            change = np.abs(forces[step:] - forces[:-step]).max(axis=1)
            found.extend(zip(change.tolist(), at[step:].tolist()))
    return found
