"""The bound on the felt specific force, against an optimum that scipy finds by a formulation of its own."""

import os
import subprocess
from pathlib import Path

import numpy as np
from scipy.optimize import LinearConstraint, minimize

ROOT = Path(__file__).resolve().parents[2]
# The limits of crates/workbench/simulation/tests/programs/bound.rs: the default rig's surge.
TRAVEL, SPEED, ACCELERATION = 0.45, 1.0, 10.0
GRAVITY, HEAD = 9.80665, 1.2
ANGLE, RATE, TILT_ACCELERATION = 0.38, np.radians(3.0), 0.2


def bound(desired, step, interval):
    """The bound and what is attained, by the crate."""
    compile_and_run = ["cargo", "run", "--quiet", "--release", "--package", "moris-simulation", "--example", "bound", "--"]
    command = [os.environ["MORIS_BOUND"]] if "MORIS_BOUND" in os.environ else compile_and_run
    text = "\n".join(repr(float(value)) for value in desired)
    done = subprocess.run(
        [*command, str(step), str(interval)], cwd=ROOT, input=text, capture_output=True, text=True, check=True
    )
    return [float(word) for word in done.stdout.split()]


def optimum(desired, step):
    """The least RMS error with accelerations that are constant over each step, by scipy.

    The unknowns are the accelerations of the platform and of s = sin(tilt), the first in units of 1 m/s2, the second in units of its
    limit. Everything else is linear in them.
    """
    count = len(desired) - 1
    largest = TILT_ACCELERATION + np.sin(ANGLE) * RATE**2
    once = step * np.tril(np.ones((count, count)))
    before = once - step * np.eye(count)
    twice = step * before.cumsum(axis=0) + 0.5 * step**2 * np.tril(np.ones((count, count)))
    nothing = np.zeros((count, count))
    limits = [
        LinearConstraint(np.hstack([once, nothing]), -SPEED, SPEED),
        LinearConstraint(np.hstack([twice, nothing]), -TRAVEL, TRAVEL),
        LinearConstraint(np.hstack([nothing, largest * once]), -RATE, RATE),
        LinearConstraint(np.hstack([nothing, largest * twice]), -np.sin(ANGLE), np.sin(ANGLE)),
        LinearConstraint(
            np.eye(2 * count),
            np.repeat([-ACCELERATION, -1.0], count),
            np.repeat([ACCELERATION, 1.0], count),
        ),
    ]
    # What is felt on an average over each step, and the mean of the desired force there.
    tilt_at_start = np.vstack([np.zeros(count), twice[:-1]])
    mean_tilt = tilt_at_start + 0.5 * step * before + step**2 / 6 * np.eye(count)
    felt = np.hstack([np.eye(count), largest * (GRAVITY * mean_tilt - HEAD * np.eye(count))])
    wanted = 0.5 * (desired[:-1] + desired[1:])
    hessian = 2 * felt.T @ felt
    result = minimize(
        lambda x: np.sum((felt @ x - wanted) ** 2),
        np.zeros(2 * count),
        jac=lambda x: 2 * felt.T @ (felt @ x - wanted),
        hess=lambda x: hessian,
        method="trust-constr",
        constraints=limits,
        options={"gtol": 1e-7, "xtol": 1e-10, "maxiter": 1000},
    )
    assert result.constr_violation < 1e-7
    # The mean error of each step, and what the desired force, linear within a step, and the motion, nearly constant there, add.
    within = np.mean(np.diff(desired) ** 2) / 12
    return np.sqrt(result.fun / count + within), np.sqrt(result.fun / count)


def test_the_bound_encloses_scipy_s_optimum():
    step = 0.1
    t = np.arange(0, 3 + step / 2, step)
    desired = 2.5 * np.clip(t / 0.5, 0, 1) - 1.5 * np.clip((t - 2.0) / 0.3, 0, 1)
    least, attained = bound(desired, step, step)
    whole, means = optimum(desired, step)
    # The relaxed program cannot cost more, and the restricted one is scipy's.
    assert least <= whole * (1 + 2e-3)
    assert abs(attained - whole) < 2e-3 * whole
    assert attained - least < 0.1 * attained, "scipy has little room to be wrong in"
    assert means > 0.3, "nothing is left to compare"
