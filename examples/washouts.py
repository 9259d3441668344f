"""Motion of two washouts from the literature for the drives of the bench, on each of its rigs.

    cargo moris bench --write-drives drives
    python3 examples/washouts.py drives
    cargo moris bench --felt reid-nahon --felt linear-mpc

Writes `reid-nahon/RIG/DRIVE.csv` and `linear-mpc/RIG/DRIVE.csv`, with the platform's pose 100 times a second. All rides are
computed at once, as columns of arrays.

- Reid-Nahon: the classical algorithm. Reid and Nahon, UTIAS Report 296, 1985.
- Linear MPC: a model of the platform and of the otoliths, with a quadratic cost and box constraints over a receding horizon.
  Dagdelen, Reymond, Kemeny, Bordier and Maizi, Control Engineering Practice 17, 2009. Garrett and Best, Vehicle System
  Dynamics 51, 2013.

Both are without preview: the plan takes the present force as constant.
"""

import sys
from pathlib import Path

import moris
import numpy as np

G, STEP, TILT_RATE = 9.80665, 0.01, np.radians(3.0)
SCALE, SCALES = 0.5, (0.5, 0.35, 0.25, 0.18, 0.12, 0.08, 0.05, 0.03)


def reid_nahon(force, rate):
    """Poses from neutral, (N, 6, rides), of forces without gravity and rates, (N, 3, rides)."""
    wn, zeta, slow, rate_wn = 2.5, 1.0, 0.4, 1.0    # break frequencies [rad/s] and damping
    position, velocity, integral, angles = (np.zeros(force.shape[1:]) for _ in range(4))
    low, low_rate, tilt = (np.zeros((2, force.shape[2])) for _ in range(3))
    poses = np.empty((len(force), 6, force.shape[2]))
    for k, (f, w) in enumerate(zip(force, rate)):
        acceleration = f - (2 * zeta * wn + slow) * velocity - (wn**2 + 2 * zeta * wn * slow) * position - wn**2 * slow * integral
        velocity = velocity + STEP * acceleration
        position = position + STEP * velocity
        integral = integral + STEP * position
        low_rate = low_rate + STEP * (wn**2 * (f[:2] - low) - 2 * zeta * wn * low_rate)
        low = low + STEP * low_rate
        wanted = np.arcsin(np.clip(np.array([low[1], -low[0]]) / G, -0.3, 0.3))
        tilt = tilt + np.clip(wanted - tilt, -TILT_RATE * STEP, TILT_RATE * STEP)
        angles = angles + STEP * (w - rate_wn * angles)
        poses[k, :3], poses[k, 3:] = position, angles
        poses[k, 3:5] += tilt
    return poses


def linear_mpc(force, travel, tilt_limit, head, horizon=20, period=0.1):
    """Travel and tilt, both (N, rides), of the forces along one axis without gravity, (N, rides).

    The state is travel, speed, tilt, tilt rate, and the slow state of the otoliths; the inputs are acceleration and the tilt's
    acceleration. Felt is acceleration + G tilt - head * tilt acceleration. Sensed is (10 s + 1) / (5 s + 1) times that.
    """
    a = np.array([[0, 1, 0, 0, 0], [0, 0, 0, 0, 0], [0, 0, 0, 1, 0], [0, 0, 0, 0, 0], [0, 0, -G / 5, 0, -1 / 5]])
    b = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 1, 0], [-1 / 5, head / 5, 1 / 5]])    # the last: the desired force
    sensed, through = np.array([0, 0, -2 * G, 0, -1]), np.array([-2, 2 * head, 2])           # the error 2 e - slow

    def discrete(step):
        """Exact for inputs that are held, by the exponential's series."""
        block = np.zeros((8, 8))
        block[:5, :5], block[:5, 5:] = a * step, b * step
        total = term = np.eye(8)
        for n in range(1, 12):
            term = term @ block / n
            total = total + term
        return total[:5, :5], total[:5, 5:]

    ad, bd = discrete(period)
    # Over the horizon: states = from_state x + from_input u + from_desired f.
    powers = [np.eye(5)]
    for _ in range(horizon):
        powers.append(ad @ powers[-1])
    from_state = np.vstack(powers[1:])
    from_input, from_desired = np.zeros((5 * horizon, 2 * horizon)), np.zeros((5 * horizon, 1))
    for i in range(horizon):
        for j in range(i + 1):
            from_input[5 * i : 5 * i + 5, 2 * j : 2 * j + 2] = powers[i - j] @ bd[:, :2]
        from_desired[5 * i : 5 * i + 5] = sum(powers[j] @ bd[:, 2:] for j in range(i + 1))
    each = np.eye(horizon)
    error = np.kron(each, sensed) @ from_input + np.kron(each, through[:2])
    error_state = np.kron(each, sensed) @ from_state
    error_desired = np.kron(each, sensed) @ from_desired + through[2]
    weights = np.tile([2.0, 1.0, 0.0, 300.0, 0.0], horizon)        # of travel, speed and tilt rate, which wash out
    effort = np.tile([0.3, 20.0], horizon)                         # of the accelerations
    hessian = error.T @ error + from_input.T @ (weights[:, None] * from_input) + np.diag(effort)
    to_state = error.T @ error_state + from_input.T @ (weights[:, None] * from_state)
    to_desired = error.T @ error_desired + from_input.T @ (weights[:, None] * from_desired)
    # Box constraints on travel, tilt and tilt rate at each step, by the method of multipliers (ADMM).
    rows = np.concatenate([5 * np.arange(horizon) + k for k in (0, 2, 3)])
    box, box_state, box_desired = from_input[rows], from_state[rows], from_desired[rows]
    limit = np.repeat([travel, tilt_limit, np.full_like(travel, TILT_RATE)], horizon, axis=0)
    size = np.repeat([1.0, 10.0, 30.0], horizon)[:, None]          # the constraints alike in size
    box, box_state, box_desired, limit = size * box, size * box_state, size * box_desired, size * limit
    rho = 10.0
    inverse = np.linalg.inv(hessian + rho * box.T @ box)
    ad, bd = discrete(STEP)
    x, held, dual = np.zeros((5, force.shape[1])), np.zeros_like(limit), np.zeros_like(limit)
    out = np.empty((2, *force.shape))
    for k, f in enumerate(force):
        offset = box_state @ x + box_desired * f
        gradient = to_state @ x + to_desired * f
        for _ in range(8):                                          # warm: held and dual are those of the last plan
            u = inverse @ (rho * box.T @ (held - offset - dual) - gradient)
            value = box @ u + offset
            held = np.clip(value + dual, -limit, limit)
            dual = dual + value - held
        x = ad @ x + bd @ np.vstack([u[:2], f[None]])
        out[:, k] = x[0], x[2]
    return out


def rotation(rate, rate_wn=1.0):
    """Angles of high-passed rates, s / (s + rate_wn)."""
    angles, out = np.zeros(rate.shape[1:]), np.empty_like(rate)
    for k, w in enumerate(rate):
        angles = angles + STEP * (w - rate_wn * angles)
        out[k] = angles
    return out


def main(folder):
    drives = {file.stem: np.genfromtxt(file, delimiter=",", names=True) for file in sorted(Path(folder).glob("*.csv"))}
    rigs = {file.stem: moris.parameters(rig=file) for file in sorted((Path(__file__).parent / "rigs").glob("*.toml"))}
    pairs = [(drive, rig) for drive in drives for rig in rigs]
    longest = max(map(len, drives.values()))
    force, rate = np.zeros((2, longest, 3, len(pairs)))
    for k, (drive, _) in enumerate(pairs):
        table = drives[drive]
        force[: len(table), :, k] = np.column_stack([table["ax"], table["ay"], table["az"] - G])
        rate[: len(table), :, k] = np.column_stack([table["wx"], table["wy"], table["wz"]])
    neutral = np.array([[0, 0, rigs[rig]["rig.neutralHeight"], 0, 0, 0] for _, rig in pairs]).T
    stroke = np.array([rigs[rig]["actuator.maxLength"] - rigs[rig]["actuator.minLength"] for _, rig in pairs])

    # Reid-Nahon: the largest scale with which the legs stay within the rig.
    left = list(range(len(pairs)))
    for scale in SCALES:
        poses = reid_nahon(scale * force[:, :, left], scale * rate[:, :, left]) + neutral[:, left]
        fits = [judged(drives, pairs[k], poses[:, :, i]) or scale == SCALES[-1] for i, k in enumerate(left)]
        for i, k in enumerate(left):
            if fits[i]:
                write("reid-nahon", pairs[k], poses[: len(drives[pairs[k][0]]), :, i])
        left = [k for i, k in enumerate(left) if not fits[i]]
        print(f"Reid-Nahon: {len(left)} of {len(pairs)} rides need a scale below {scale}")
        if not left:
            break

    # Linear MPC: constraints in proportion to the stroke keep it within the rig.
    travel, tilt, head = 0.22 * stroke, np.minimum(0.3, 0.25 * stroke), 1.0
    surge = linear_mpc(SCALE * force[:, 0], travel, tilt, head)
    sway = linear_mpc(SCALE * force[:, 1], travel, tilt, head)
    heave = linear_mpc(SCALE * force[:, 2], 0.5 * travel, np.zeros_like(tilt), head)
    angles = SCALE * np.minimum(1.0, stroke / 0.6) * rotation(rate)
    poses = np.stack([surge[0], sway[0], heave[0], angles[:, 0] + sway[1], angles[:, 1] - surge[1], angles[:, 2]], axis=1) + neutral
    for k, pair in enumerate(pairs):
        write("linear-mpc", pair, poses[: len(drives[pair[0]]), :, k])


def judged(drives, pair, poses):
    """True if the motion stays within the rig."""
    drive, rig = pair
    table = drives[drive]
    columns = {name: table[name] for name in ("time", "ax", "ay", "az", "wx", "wy", "wz")}
    rig = Path(__file__).parent / "rigs" / f"{rig}.toml"
    return moris.measure(columns, pose=poses[: len(table)], rig=rig).fits


def write(name, pair, poses):
    drive, rig = pair
    file = Path(name) / rig / f"{drive}.csv"
    file.parent.mkdir(parents=True, exist_ok=True)
    rows = np.column_stack([STEP * np.arange(len(poses)), poses])
    np.savetxt(file, rows, delimiter=",", header="time,x,y,z,roll,pitch,yaw", comments="", fmt="%.10g")


if __name__ == "__main__":
    main(*sys.argv[1:])
