"""What the rider feels, against numerical differentiation of the FMU's own pose at 1 kHz."""

import numpy as np
import pytest
from conftest import ANGLES, AXES
from scipy.spatial.transform import Rotation

STEP = 1e-3
GRAVITY = 9.80665
HEIGHT, TORSO = 1.2, 0.75
BODY = 2


@pytest.mark.parametrize("lean", [0.0, 0.2])
def test_felt_motion_is_that_of_the_pose(washout, lean):
    w = washout(parameters={"angularVelocityFrame": BODY})
    t = STEP * np.arange(12_000)
    fade = np.clip(t / 2.0, 0, 1) ** 2 * (3 - 2 * np.clip(t / 2.0, 0, 1))
    wave = lambda size, frequency, phase: size * fade * np.sin(2 * np.pi * frequency * t + phase)
    inputs = {
        "vehicle.specificForce.x": wave(0.8, 0.2, 0.0),
        "vehicle.specificForce.y": wave(0.6, 0.25, 1.0),
        "vehicle.specificForce.z": GRAVITY + wave(0.5, 0.5, 2.0),
        "vehicle.angularVelocity.x": wave(0.05, 0.3, 0.5),
        "vehicle.angularVelocity.y": wave(0.04, 0.25, 1.5),
        "vehicle.angularVelocity.z": wave(0.10, 0.35, 2.5),
        "rider.lean": np.full_like(t, lean),
    }
    # The head's lean shifts the removal of gravity: keep z as upright riders feel it.
    inputs["vehicle.orientation.roll"] = np.full_like(t, -lean)
    slopes = {name: np.gradient(values, STEP) for name, values in inputs.items()}
    outputs = (
        [f"platform.position.{a}" for a in AXES]
        + [f"platform.orientation.{a}" for a in ANGLES]
        + [f"rider.specificForce.{a}" for a in AXES]
        + [f"rider.angularVelocity.{a}" for a in AXES]
    )
    rows = w.run(STEP, inputs, outputs, slopes)
    position, angles, felt, felt_omega = np.split(rows, 4, axis=1)
    rotation = Rotation.from_euler("ZYX", angles[:, ::-1])
    head = np.array([0.0, -TORSO * np.sin(lean), HEIGHT - TORSO + TORSO * np.cos(lean)])
    head_position = position + rotation.apply(head)
    acceleration = (head_position[2:] - 2 * head_position[1:-1] + head_position[:-2]) / STEP**2
    to_head = (rotation[1:-1] * Rotation.from_euler("x", lean)).inv()
    expected = to_head.apply(acceleration + np.array([0.0, 0.0, GRAVITY]))
    settled = slice(100 if lean == 0.0 else 4000, None)  # the first moments of a leaning rider are a jerk
    assert np.max(np.abs(felt[1:-1] - expected)[settled]) < 5e-3
    turned = (rotation[:-2].inv() * rotation[2:]).as_rotvec() / (2 * STEP)  # in platform axes
    expected_omega = Rotation.from_euler("x", lean).inv().apply(turned)
    assert np.max(np.abs(felt_omega[1:-1] - expected_omega)[settled]) < 1e-3
    assert np.max(np.abs(felt[:, 0])) > 0.3
