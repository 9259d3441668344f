"""Step the washout beside a vehicle model in fmpy, as a co-simulation master does.

    python examples/fmpy/ride.py --fmu target/fmu/MorisWashout.fmu --rate 1000 --picture ride.png

The vehicle is a few lines of Python: a motorcycle that accelerates, rides a slalom and brakes. Any other model will do
that delivers, at the rider's head and in the head's axes, what an accelerometer and a gyroscope there would read.
"""

import argparse
import math
import shutil
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

GRAVITY = 9.80665
DURATION = 40.0  # s

INPUTS = [
    "vehicle.specificForce.x", "vehicle.specificForce.y", "vehicle.specificForce.z",
    "vehicle.angularVelocity.x", "vehicle.angularVelocity.y", "vehicle.angularVelocity.z",
    "vehicle.orientation.roll", "vehicle.orientation.pitch", "vehicle.orientation.yaw",
    "vehicle.speed",
]
OUTPUTS = [
    "rider.specificForce.x", "rider.specificForce.y", "rider.specificForce.z",
    "rider.angularVelocity.x", "rider.angularVelocity.y", "rider.angularVelocity.z",
    *(f"actuator[{i}].length" for i in range(1, 7)),
    "tilt.rollRate", "tilt.pitchRate",
]
# A rolled platform adds gravity to the sway that is felt, so the roll is cued at a quarter of its size; and the slalom's
# sway is small and quick, so the platform's travel may reproduce it.
PARAMETERS = {
    "scale.angularVelocity.x": 0.25,
    "splitter.y.omega1": 0.5, "splitter.y.zeta1": 0.6,
    "splitter.y.omega2": 0.5, "splitter.y.zeta2": 0.6,
}
BODY_AXES = 2  # angularVelocityFrame = body: the vehicle's rates are given as a gyroscope on it measures them


def smooth(t, begin, duration):
    """A step from 0 to 1 that begins at `begin` and takes `duration`, with a continuous acceleration."""
    x = min(max((t - begin) / duration, 0.0), 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x * x)


class Motorcycle:
    """A motorcycle in balance: it leans as its turning asks for, and its tyres hold whatever is asked of them."""

    head_height = 1.5  # of the rider's head above the road, m

    def __init__(self):
        self.speed = 5.0
        self.yaw = 0.0

    def acceleration(self, t):
        gently_up = 2.0 * (smooth(t, 2, 5) - smooth(t, 9, 4))
        down = 2.0 * (smooth(t, 26, 5) - smooth(t, 32, 4))
        return gently_up - down

    def lean(self, t):
        """Roll angle, its rate and acceleration: a slalom of 8 degrees at 0.25 Hz from 12 s to 24 s."""
        amplitude = math.radians(8.0)
        omega = 2.0 * math.pi * 0.25

        def angle(t):
            return amplitude * (smooth(t, 12, 3) - smooth(t, 21, 3)) * math.sin(omega * (t - 12.0))

        d = 1e-4
        before, now, after = angle(t - d), angle(t), angle(t + d)
        return now, (after - before) / (2 * d), (after - 2 * now + before) / d**2

    def sensors(self, t):
        """What the rider's head feels at time t: specific force, angular velocity (body axes), orientation, speed."""
        roll, roll_rate, roll_acceleration = self.lean(t)
        # In a balanced turn to the left the motorcycle leans to the left, which is a negative roll.
        yaw_rate = -GRAVITY * math.tan(roll) / self.speed
        h = self.head_height
        sin, cos = math.sin(roll), math.cos(roll)
        # Acceleration of the head less gravity, along the heading, to the left and upwards ...
        along = self.acceleration(t)
        left = self.speed * yaw_rate - h * (cos * roll_acceleration - sin * roll_rate**2)
        up = GRAVITY - h * (sin * roll_acceleration + cos * roll_rate**2)
        # ... and the same in the axes of the leaning head.
        return [
            along, cos * left + sin * up, -sin * left + cos * up,
            roll_rate, sin * yaw_rate, cos * yaw_rate,
            roll, 0.0, self.yaw,
            self.speed,
        ]

    def advance(self, t, step):
        """To t + step, by the midpoint rule."""
        roll, _, _ = self.lean(t + 0.5 * step)
        speed = self.speed + 0.5 * step * self.acceleration(t)
        self.speed += step * self.acceleration(t + 0.5 * step)
        self.yaw += step * -GRAVITY * math.tan(roll) / speed


def ride(fmu, rate):
    """Rides at `rate` communication steps a second. Returns times, inputs and outputs, a row a step."""
    description = read_model_description(fmu)
    references = {v.name: v.valueReference for v in description.modelVariables}
    inputs = [references[name] for name in INPUTS]
    outputs = [references[name] for name in OUTPUTS]
    directory = extract(fmu)
    washout = FMU2Slave(
        guid=description.guid,
        unzipDirectory=directory,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="washout",
    )
    washout.instantiate()
    try:
        washout.setupExperiment(startTime=0.0, stopTime=DURATION)
        washout.enterInitializationMode()
        for name, value in PARAMETERS.items():
            washout.setReal([references[name]], [value])
        washout.setInteger([references["angularVelocityFrame"]], [BODY_AXES])
        washout.exitInitializationMode()

        motorcycle = Motorcycle()
        step = 1.0 / rate
        times, felt_by_vehicle, felt_on_platform = [], [], []
        now = motorcycle.sensors(0.0)
        for k in range(round(DURATION * rate)):
            t = k * step
            motorcycle.advance(t, step)
            then = motorcycle.sensors(t + step)
            washout.setReal(inputs, now)
            # The vehicle is one step ahead, so the input's slope over the step is known. Without it the input would be
            # a staircase, and each stair a jolt: at 100 Hz the actuators could feel it.
            slope = [(b - a) / step for a, b in zip(now, then)]
            washout.setRealInputDerivatives(inputs, [1] * len(inputs), slope)
            washout.doStep(currentCommunicationPoint=t, communicationStepSize=step)
            now = then
            times.append(t + step)
            felt_by_vehicle.append(now)
            felt_on_platform.append(washout.getReal(outputs))
        washout.terminate()
    finally:
        washout.freeInstance()
        shutil.rmtree(directory, ignore_errors=True)
    return np.array(times), np.array(felt_by_vehicle), np.array(felt_on_platform)


def draw(path, times, desired, outputs, rate):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(4, 1, figsize=(9, 11), sharex=True, layout="constrained")
    figure.suptitle(f"A ride through the washout, {rate} communication steps a second")
    for axis, k, name in zip(axes, range(2), ["surge", "sway"]):
        axis.plot(times, desired[:, k], color="0.55", label="vehicle")
        axis.plot(times, outputs[:, k], color="C0", label="platform")
        axis.set_ylabel(f"specific force,\n{name} [m/s²]")
        axis.legend(loc="upper right")
    axes[2].plot(times, np.degrees(desired[:, 3]), color="0.55", label="vehicle")
    axes[2].plot(times, np.degrees(outputs[:, 3]), color="C0", label="platform")
    axes[2].set_ylabel("roll rate [°/s]")
    axes[2].legend(loc="upper right")
    axes[3].plot(times, outputs[:, 6:12], label=[f"{i}" for i in range(1, 7)])
    for limit in (1.0, 1.6):
        axes[3].axhline(limit, color="black", linestyle="--", linewidth=1)
    axes[3].set_ylabel("actuator length [m]")
    axes[3].legend(ncols=6, loc="lower right", title="actuator")
    axes[3].set_xlabel("time [s]")
    for axis in axes:
        axis.grid(alpha=0.3)
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/fmu/MorisWashout.fmu"), help="default: %(default)s")
    parser.add_argument("--rate", type=int, default=1000, help="communication steps a second (default: %(default)s)")
    parser.add_argument("--picture", type=Path, help="write a picture of the ride, a PNG or SVG file")
    arguments = parser.parse_args()
    times, desired, outputs = ride(arguments.fmu, arguments.rate)
    for k, name in enumerate(["surge", "sway", "heave"]):
        error = outputs[:, k] - desired[:, k]
        print(f"{name}: RMS error of the felt specific force {np.sqrt(np.mean(error**2)):.3f} m/s2")
    lengths = outputs[:, 6:12]
    print(f"actuators: {lengths.min():.3f} to {lengths.max():.3f} m")
    if arguments.picture:
        draw(arguments.picture, times, desired, outputs, arguments.rate)
        print(f"picture: {arguments.picture}")


if __name__ == "__main__":
    main()
