"""A topic of ROS 2 as the source of `moris live`, with CycloneDDS as the publisher, as ROS 2's `rmw_cyclonedds` has it.

    pip install cyclonedds
    cargo build --bin moris --features moris/ros2
    sudo MORIS=target/debug/moris unshare --net python3 tests/live/ros2.py

The network that unshare makes has nothing but the loopback, on which DDS needs multicast.
"""

import math
import subprocess
import threading
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float64, int32, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from rig import Controller, Live


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Imu(IdlStruct, typename="sensor_msgs::msg::dds_::Imu_"):
    header: Header
    orientation: Quaternion
    orientation_covariance: array[float64, 9]
    angular_velocity: Vector3
    angular_velocity_covariance: array[float64, 9]
    linear_acceleration: Vector3
    linear_acceleration_covariance: array[float64, 9]


def publish(reliability, ended):
    """A level drive at 100 Hz."""
    qos = Qos(reliability, Policy.History.KeepLast(10))
    participant = DomainParticipant(0)
    writer = DataWriter(participant, Topic(participant, "rt/imu/data", Imu, qos=qos), qos=qos)
    zeros = [0.0] * 9
    while not ended.wait(0.01):
        now = time.time()
        header = Header(Time(int(now), int(now % 1 * 1e9)), "imu_link")
        force = Vector3(1.5 * math.sin(0.9 * now), 0.3, 9.80665)
        writer.write(Imu(header, Quaternion(0.0, 0.0, 0.0, 1.0), zeros, Vector3(0.0, 0.0, 0.0), zeros, force, zeros))


def drive(reliability):
    ended = threading.Event()
    threading.Thread(target=publish, args=(reliability, ended)).start()
    try:
        controller = Controller()
        live = Live(controller, "--engage", source=["--from", "ros2:/imu/data"])
        live.wait_for(" s  engaged")
        ended.set()
        for effect in ("telemetry: silent", " s  frozen", " s  disengaging"):
            live.wait_for(effect)
        live.interrupt()
        status, printed = live.end()
        controller.ended.set()
    finally:
        ended.set()
    assert status == 0 and not controller.faults, (status, controller.faults[:5])
    counts = next(text for text in printed.splitlines() if text.startswith("telemetry: "))
    assert " 0 of another format, 0 bad" in counts, counts
    print(f"{type(reliability).__name__}: {counts}", flush=True)


if __name__ == "__main__":
    subprocess.run(["ip", "link", "set", "lo", "up", "multicast", "on"], check=True)
    subprocess.run(["ip", "route", "add", "224.0.0.0/4", "dev", "lo"], check=True)
    drive(Policy.Reliability.BestEffort)
    drive(Policy.Reliability.Reliable(duration(seconds=1)))
