"""Passes a topic of ROS 2 with messages sensor_msgs/Imu on to `moris-live`, as UDP packets in JSON.

    python3 examples/ros2_bridge.py /imu/data
    cargo live --from udp:4444 --format json --dry
"""

import json
import math
import socket
import sys

MORIS_LIVE = ("127.0.0.1", 4444)


def packet(imu):
    """A packet of the format `json`; None without an acceleration. A covariance of -1 marks what is not measured."""
    if imu.linear_acceleration_covariance[0] == -1:
        return None
    motion = {"time": imu.header.stamp.sec + 1e-9 * imu.header.stamp.nanosec}
    motion |= {f"a{axis}": getattr(imu.linear_acceleration, axis) for axis in "xyz"}
    if imu.angular_velocity_covariance[0] != -1:
        motion |= {f"w{axis}": getattr(imu.angular_velocity, axis) for axis in "xyz"}
    x, y, z, w = (getattr(imu.orientation, part) for part in "xyzw")
    square = x * x + y * y + z * z + w * w
    if imu.orientation_covariance[0] != -1 and square > 0:
        motion["roll"] = math.atan2(2 * (w * x + y * z), square - 2 * (x * x + y * y))
        motion["pitch"] = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x) / square)))
        motion["yaw"] = math.atan2(2 * (w * z + x * y), square - 2 * (y * y + z * z))
    return json.dumps(motion).encode()


def main(topic):
    import rclpy
    from rclpy.qos import qos_profile_sensor_data
    from sensor_msgs.msg import Imu

    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    rclpy.init()
    node = rclpy.create_node("moris_bridge")
    pass_on = lambda imu: (sent := packet(imu)) and sender.sendto(sent, MORIS_LIVE)  # noqa: E731
    node.create_subscription(Imu, topic, pass_on, qos_profile_sensor_data)
    rclpy.spin(node)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "/imu/data")
