"""The linear filters, against scipy's own integration of their transfer functions."""

import numpy as np
import pytest
from scipy import signal

STEP = 1e-3
GRAVITY = 9.80665
COMPENSATION_NONE = 1
RECONSTRUCTION_HOLD = 1
CLASSICAL = 1
TRACKING_EXACT = 1
# Filters of fourth order on cues as they are given, inputs held.
PLAIN = {
    "strategy": CLASSICAL,
    "tilt.tracking": TRACKING_EXACT,
    "splitter.order": 4,
    **{f"splitter.{axis}.{omega}": 2.5 for axis in "xyz" for omega in ("omega1", "omega2")},
    **{f"splitter.{axis}.{zeta}": 1.0 for axis in "xyz" for zeta in ("zeta1", "zeta2")},
    "angular.order": 4,
    **{f"scale.specificForce.{axis}": 1.0 for axis in "xyz"},
    **{f"scale.angularVelocity.{axis}": 1.0 for axis in "xyz"},
    "input.rateCutoff": 0.0,
    "input.reconstruction": RECONSTRUCTION_HOLD,
    "compensation": COMPENSATION_NONE,
}


def denominator(omega1, zeta1, omega2, zeta2):
    return np.polymul([1, 2 * zeta1 * omega1, omega1**2], [1, 2 * zeta2 * omega2, omega2**2])


def held_response(numerator, denominator, samples):
    """The response at the end of each step to an input held over it."""
    a, b, c, d, _ = signal.cont2discrete(signal.tf2ss(numerator, denominator), STEP, method="zoh")
    # Held samples act from their own step's start to its end: the state after the step, read without feedthrough.
    _, _, states = signal.dlsim((a, b, c, d, STEP), np.append(samples, 0.0))
    return states[1:] @ c.ravel()


def smooth_input(duration=20.0):
    t = np.arange(0.0, duration, STEP)
    return t, 0.01 * np.sin(2 * np.pi * 0.3 * t) * np.sin(np.pi * t / duration) ** 2


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_position_is_s2_over_d(washout, axis):
    poles = (1.7, 0.8, 2.9, 1.1)
    names = ("omega1", "zeta1", "omega2", "zeta2")
    parameters = {f"splitter.{axis}.{name}": value for name, value in zip(names, poles)}
    w = washout(parameters=PLAIN | parameters)
    _, u = smooth_input()
    rest = GRAVITY if axis == "z" else 0.0
    position = w.run(STEP, {f"vehicle.specificForce.{axis}": u + rest}, [f"platform.position.{axis}"])[:, 0]
    neutral = 1.091 if axis == "z" else 0.0
    expected = held_response([1, 0, 0], denominator(*poles), u)
    assert np.max(np.abs(expected)) > 1e-4
    assert np.max(np.abs(position - neutral - expected)) < 1e-6 * np.max(np.abs(expected))


@pytest.mark.parametrize("angle, axis", [("roll", "x"), ("pitch", "y"), ("yaw", "z")])
def test_angle_is_s3_over_d(washout, angle, axis):
    poles = (0.7, 0.9, 1.3, 1.2)
    names = ("omega1", "zeta1", "omega2", "zeta2")
    parameters = {f"angular.{angle}.{name}": value for name, value in zip(names, poles)}
    w = washout(parameters=PLAIN | parameters)
    _, u = smooth_input()
    angles = w.run(STEP, {f"vehicle.angularVelocity.{axis}": u}, [f"platform.orientation.{angle}"])[:, 0]
    expected = held_response([1, 0, 0, 0], denominator(*poles), u)
    assert np.max(np.abs(expected)) > 1e-4
    assert np.max(np.abs(angles - expected)) < 1e-6 * np.max(np.abs(expected))


@pytest.mark.parametrize("axis, angle, sign", [("x", "pitch", -1.0), ("y", "roll", 1.0)])
def test_tilt_follows_the_low_pass(washout, axis, angle, sign):
    poles = (2.5, 1.0, 2.5, 1.0)  # those of PLAIN
    w = washout(parameters=PLAIN)
    t, u = smooth_input()
    tilt = w.run(STEP, {f"vehicle.specificForce.{axis}": u}, [f"tilt.{angle}"])[:, 0]
    d = denominator(*poles)
    low_pass = held_response(d[1:], d, u)  # 1 - s^4/D
    target = sign * np.arcsin(low_pass / GRAVITY)
    lags = np.arange(0, 60)
    errors = [np.sum((tilt[lag:] - target[: len(target) - lag]) ** 2) for lag in lags]
    assert lags[int(np.argmin(errors))] * STEP < 0.020
    assert min(errors) < 1e-4 * np.sum(target**2)
