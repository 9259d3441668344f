"""The bridge from ROS 2: what becomes of a message, without an installation of ROS 2."""

import json
import math
from types import SimpleNamespace

import pytest
from conftest import example

ZEROS = [0.0] * 9
NOT_MEASURED = [-1.0, *ZEROS[1:]]


def imu(quaternion=(0.0, 0.0, 0.6, 0.8), attitude=ZEROS, rates=ZEROS, forces=ZEROS):
    """A message with a quaternion x, y, z, w and these covariances."""
    part = lambda names, values: SimpleNamespace(**dict(zip(names, values, strict=True)))  # noqa: E731
    return SimpleNamespace(
        header=SimpleNamespace(stamp=part(("sec", "nanosec"), (1_700_000_000, 250_000_000))),
        orientation=part("xyzw", quaternion),
        orientation_covariance=attitude,
        angular_velocity=part("xyz", (0.25, -0.5, 1.0)),
        angular_velocity_covariance=rates,
        linear_acceleration=part("xyz", (-2.0, 0.5, 10.0)),
        linear_acceleration_covariance=forces,
    )


def sent(message):
    return json.loads(example("ros2_bridge").packet(message))


def test_a_message_has_the_axes_and_units_of_the_washout():
    expected = {"time": 1_700_000_000.25, "ax": -2.0, "ay": 0.5, "az": 10.0, "wx": 0.25, "wy": -0.5, "wz": 1.0}
    expected |= {"roll": 0.0, "pitch": 0.0, "yaw": 2 * math.atan2(0.6, 0.8)}
    assert sent(imu()) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("turn", ["roll", "pitch", "yaw"])
def test_a_turn_about_each_axis_has_the_sign_of_the_washout(turn):
    quaternion = [math.sin(0.15) * (turn == name) for name in ("roll", "pitch", "yaw")]
    # A quaternion of twice the length is the same attitude.
    angles = sent(imu([2 * part for part in (*quaternion, math.cos(0.15))]))
    for name in ("roll", "pitch", "yaw"):
        assert angles[name] == pytest.approx(0.3 * (name == turn), abs=1e-12)


def test_what_a_driver_does_not_measure_stays_out():
    for blind in (imu(attitude=NOT_MEASURED, rates=NOT_MEASURED), imu((0, 0, 0, 0), rates=NOT_MEASURED)):
        assert sorted(sent(blind)) == ["ax", "ay", "az", "time"]
    assert example("ros2_bridge").packet(imu(forces=NOT_MEASURED)) is None
