"""Simulates the whole simulator: motorcycle, washout and Stewart platform, connected by SSP.

    cargo build-ssp
    python3 examples/06_whole_simulator.py

The system's inputs are the rider's commands: throttle, brake and lean. The motorcycle accelerates, rides a slalom of
15° and brakes to a stop. Draws `target/examples/06_whole_simulator.svg`.
"""

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssv
from picture import BLUE, GREY, ORANGE, draw

DURATION = 45.0  # s
COMMANDS = {
    "throttle": lambda t: np.interp(t, [1, 3, 9, 12, 29, 30], [0, 0.3, 0.3, 0.1, 0.1, 0]),
    "brake": lambda t: np.interp(t, [30, 33], [0, 0.25]),
    # From 14 s to 28 s, to the right first, 4 s from right to right [rad].
    "lean": lambda t: np.radians(15) * np.interp(t, [14, 16, 26, 28], [0, 1, 1, 0]) * np.sin(np.pi / 2 * (t - 14)),
}


def simulate(ssp="target/fmu/MotorcycleSimulator.ssp", step=5e-3):
    """The values of all connectors at each communication step of `step` seconds, by name."""
    # FMPy applies the package's parameters only if it is given them.
    parameters = read_ssv(ssp, "resources/MotorcycleSimulator.ssv")
    result = simulate_ssp(ssp, stop_time=DURATION, step_size=step, parameter_set=parameters, input=COMMANDS)
    # In its first step FMPy sets every connected input to zero, the specific force too. The jolt ends within 0.5 s.
    return result[result["time"] >= 0.5]


def legs(result, component, quantity):
    """A quantity of the six actuators, a column each."""
    return np.stack([result[f"{component}.actuator[{i}].{quantity}"] for i in range(1, 7)], axis=1)


def print_errors(result):
    speed, lengths = result["motorcycle.vehicle.speed"], legs(result, "platform", "length")
    print(f"top speed {3.6 * speed.max():.0f} km/h, at the end {speed[-1]:g} m/s")
    for name, axis in (("surge", "x"), ("sway", "y"), ("heave", "z")):
        desired, commanded, felt = (
            result[f"{part}.specificForce.{axis}"] for part in ("motorcycle.vehicle", "washout.rider", "platform.rider")
        )
        total, platform = np.sqrt(np.mean((felt - desired) ** 2)), np.sqrt(np.mean((felt - commanded) ** 2))
        print(f"{name}: RMS error {total:.3f} m/s²; felt against commanded {platform:.3f} m/s²")
    print(f"actuators: {lengths.min():.3f} to {lengths.max():.3f} m")


def draw_result(path, result):
    def force(axis):
        return [
            ("desired", result[f"motorcycle.vehicle.specificForce.{axis}"], GREY),
            ("commanded", result[f"washout.rider.specificForce.{axis}"], ORANGE),
            ("felt", result[f"platform.rider.specificForce.{axis}"], BLUE),
        ]

    def rate(part):
        return np.degrees(result[f"{part}.angularVelocity.x"])

    def actuators(quantity):
        return [(f"{i}", column, None) for i, column in enumerate(legs(result, "platform", quantity).T, 1)]

    lean = np.degrees(result["motorcycle.vehicle.orientation.roll"])
    draw(path, "Motorcycle, washout and platform", result["time"], [
        ("motorcycle", [("speed [km/h]", 3.6 * result["motorcycle.vehicle.speed"], "C2"), ("lean [°]", lean, "C4")]),
        ("specific force,\nsurge [m/s²]", force("x")),
        ("specific force,\nsway [m/s²]", force("y")),
        ("roll rate [°/s]", [("desired", rate("motorcycle.vehicle"), GREY), ("felt", rate("platform.rider"), BLUE)]),
        ("actuator length [m]", actuators("length") + [(None, 1.0, None), (None, 1.6, None)]),
        ("actuator force [N]", actuators("force")),
    ])


def main():
    result = simulate()
    print_errors(result)
    draw_result("target/examples/06_whole_simulator.svg", result)


if __name__ == "__main__":
    main()
