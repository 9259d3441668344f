"""Steps the FMU beside a vehicle model, as a co-simulation master does.

    cargo build-fmu
    python3 examples/03_beside_a_vehicle.py

The vehicle is a car that accelerates, takes a bend and brakes. Another model replaces the class `Car` if it gives the
specific force at the rider's head, in the head's axes, and the vehicle's angular velocity in its own axes. Draws
`target/examples/03_beside_a_vehicle.svg`.
"""

import shutil

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from picture import BLUE, GREY, draw

GRAVITY = 9.80665
DURATION = 40.0  # s
AXES = "xyz"
INPUTS = [
    *(f"vehicle.specificForce.{axis}" for axis in AXES),
    *(f"vehicle.angularVelocity.{axis}" for axis in AXES),
    *(f"vehicle.orientation.{angle}" for angle in ("roll", "pitch", "yaw")),
    "vehicle.speed",
]
LENGTHS = [f"actuator[{i}].length" for i in range(1, 7)]
OUTPUTS = [f"rider.specificForce.{axis}" for axis in AXES] + ["rider.angularVelocity.z"]
OUTPUTS += LENGTHS + ["tilt.rollRate", "tilt.pitchRate"]
BODY_AXES = 2  # second item of the enumeration angularVelocityFrame: rates as a gyroscope on the vehicle reads them


class Car:
    """A car without suspension on a flat road."""

    def __init__(self):
        self.time, self.speed, self.yaw = 0.0, 5.0, 0.0

    def acceleration(self):
        """Acceleration along the road [m/s²]: faster from 2 s to 12 s, slower from 28 s to 38 s."""
        return np.interp(self.time, [2, 6, 8, 12, 28, 32, 34, 38], [0, 2, 2, 0, 0, -2, -2, 0])

    def yaw_rate(self):
        """Yaw rate [rad/s]: a bend to the left from 13 s to 27 s."""
        return np.interp(self.time, [13, 17, 23, 27], [0, 0.08, 0.08, 0])

    def sensors(self):
        """Values of INPUTS: specific force, angular velocity (body axes), orientation, speed."""
        force = [self.acceleration(), self.speed * self.yaw_rate(), GRAVITY]
        return np.array([*force, 0.0, 0.0, self.yaw_rate(), 0.0, 0.0, self.yaw, self.speed])

    def advance(self, step):
        self.yaw += step * self.yaw_rate()
        self.speed += step * self.acceleration()
        self.time += step


def simulate(fmu="target/fmu/MorisWashout.fmu", rate=1000):
    """Simulates at `rate` communication steps a second. Returns times, inputs and outputs, a row a step."""
    description = read_model_description(fmu)
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    inputs, outputs = [references[name] for name in INPUTS], [references[name] for name in OUTPUTS]
    directory = extract(fmu)
    model = description.coSimulation.modelIdentifier
    washout = FMU2Slave(guid=description.guid, unzipDirectory=directory, modelIdentifier=model, instanceName="washout")
    washout.instantiate()
    try:
        washout.setupExperiment(startTime=0.0, stopTime=DURATION)
        washout.enterInitializationMode()
        washout.setInteger([references["angularVelocityFrame"]], [BODY_AXES])
        car, step, rows = Car(), 1.0 / rate, []
        now = car.sensors()
        washout.setReal(inputs, now.tolist())
        washout.exitInitializationMode()

        for k in range(round(DURATION * rate)):
            car.advance(step)
            then = car.sensors()
            washout.setReal(inputs, now.tolist())
            # The vehicle is one step ahead, so that the slopes over the step are known. Without them the inputs
            # would ramp from those of the step before, a step late.
            washout.setRealInputDerivatives(inputs, [1] * len(inputs), ((then - now) / step).tolist())
            washout.doStep(currentCommunicationPoint=k * step, communicationStepSize=step)
            now = then
            rows.append([car.time, *now, *washout.getReal(outputs)])
        washout.terminate()
    finally:
        washout.freeInstance()
        shutil.rmtree(directory, ignore_errors=True)
    return np.split(np.array(rows), [1, 1 + len(INPUTS)], axis=1)


def main():
    time, desired, outputs = simulate()
    felt, lengths = outputs[:, :4], outputs[:, 4:10]
    for k, axis in enumerate(("surge", "sway", "heave")):
        error = np.sqrt(np.mean((felt[:, k] - desired[:, k]) ** 2))
        print(f"{axis}: RMS error of the felt specific force {error:.3f} m/s²")
    print(f"actuators: {lengths.min():.3f} to {lengths.max():.3f} m")
    draw("target/examples/03_beside_a_vehicle.svg", "The FMU beside a vehicle model", time[:, 0], [
        *((f"specific force,\n{axis} [m/s²]", [("desired", desired[:, k], GREY), ("felt", felt[:, k], BLUE)])
          for k, axis in enumerate(("surge", "sway"))),
        ("yaw rate [°/s]", [("desired", np.degrees(desired[:, 5]), GREY), ("felt", np.degrees(felt[:, 3]), BLUE)]),
        ("actuator length [m]", [(f"{i + 1}", lengths[:, i], None) for i in range(6)]
         + [(None, 1.0, None), (None, 1.6, None)]),
    ])


if __name__ == "__main__":
    main()
