"""The legs, against scipy's rotations."""

import numpy as np
from conftest import ANGLES, AXES
from scipy.spatial.transform import Rotation


def test_legs_are_the_inverse_kinematics_of_the_pose(washout):
    rng = np.random.default_rng(1)
    w = washout(parameters={"scale.angularVelocity.x": 0.3})
    joints = {
        part: np.array([w.vector(f"rig.{part}[{i}]") for i in range(1, 7)]) for part in ("base", "platform")
    }
    step, count = 0.01, 2000
    t = step * np.arange(count)
    inputs = {}
    for name, size, rest in (("specificForce", 1.0, 9.80665), ("angularVelocity", 0.1, 0.0)):
        for axis in AXES:
            frequency, phase = rng.uniform(0.1, 0.8), rng.uniform(0, 2 * np.pi)
            offset = rest if axis == "z" else 0.0
            inputs[f"vehicle.{name}.{axis}"] = offset + size * np.sin(2 * np.pi * frequency * t + phase)
    outputs = (
        [f"platform.position.{a}" for a in AXES]
        + [f"platform.orientation.{a}" for a in ANGLES]
        + [f"actuator[{i}].length" for i in range(1, 7)]
        + [f"actuator[{i}].velocity" for i in range(1, 7)]
        + [f"platform.velocity.{a}" for a in AXES]
        + [f"platform.angularVelocity.{a}" for a in AXES]
    )
    rows = w.run(step, inputs, outputs)
    moved = 0.0
    for row in rows:
        position, angles, lengths, rates, velocity, omega = np.split(row, [3, 6, 12, 18, 21])
        rotation = Rotation.from_euler("ZYX", angles[::-1])  # yaw, pitch, roll about the moving axes
        arms = rotation.apply(joints["platform"])
        legs = position + arms - joints["base"]
        expected = np.linalg.norm(legs, axis=1)
        assert np.max(np.abs(lengths - expected)) < 1e-12
        joint_velocity = velocity + np.cross(omega, arms)
        assert np.max(np.abs(rates - np.sum(legs * joint_velocity, axis=1) / expected)) < 1e-12
        moved = max(moved, np.max(np.abs(angles)))
    assert moved > 0.05


def test_default_rig_is_as_documented(washout):
    w = washout()
    for part, radius, degrees in (
        ("base", 1.0, (-8, 8, 112, 128, 232, 248)),
        ("platform", 0.85, (-52, 52, 68, 172, 188, 292)),
    ):
        for i, angle in enumerate(np.radians(degrees), start=1):
            expected = [radius * np.cos(angle), radius * np.sin(angle), 0.0]
            assert np.allclose(w.vector(f"rig.{part}[{i}]"), expected, rtol=0, atol=1e-15)
    lengths = w.get(*(f"actuator[{i}].length" for i in range(1, 7)))
    assert np.allclose(lengths, 1.29996, rtol=0, atol=5e-6)
