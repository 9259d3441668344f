"""Simulates a lap: the motorcycle follows a path by itself and tells the washout what comes.

    cargo build-ssp --system MotorcycleLap
    python3 examples/10_lap.py

Draws `target/examples/10_lap.svg` and writes the lap as a recording, `target/examples/lap.csv`.
"""

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from picture import BLUE, GREY, ORANGE, draw

DURATION = 100.0  # s
ANGLES = ("roll", "pitch", "yaw")


def simulate(ssp="target/fmu/MotorcycleLap.ssp", step=1e-2, duration=DURATION):
    """The values of all connectors at each communication step of `step` seconds, by name."""
    return simulate_ssp(ssp, stop_time=duration, step_size=step)


def errors(result):
    """RMS of the desired specific force as a deviation from rest, and of its error on the platform [m/s²]: surge, sway."""
    found = []
    for axis in "xy":
        desired, felt = (result[f"{part}.specificForce.{axis}"] for part in ("motorcycle.vehicle", "platform.rider"))
        found.append((np.sqrt(np.mean(desired**2)), np.sqrt(np.mean((felt - desired) ** 2))))
    return found


def print_errors(result):
    lengths = np.stack([result[f"actuatorLength{i}"] for i in range(1, 7)])
    print(f"{result['motorcycle.path.distance'][-1]:.0f} m at up to {3.6 * result['speed'].max():.0f} km/h")
    print(f"deviation from the path: at most {np.abs(result['motorcycle.path.deviation']).max():.2f} m")
    for name, (rest, error) in zip(("surge", "sway"), errors(result)):
        print(f"{name}: RMS error {error:.2f} m/s², of a platform at rest {rest:.2f} m/s²")
    print(f"actuators: {lengths.min():.3f} to {lengths.max():.3f} m; limited: {np.mean(result['actuatorLimited']):.1%} of the lap")


def write_recording(path, result):
    """The motorcycle's outputs at 100 Hz, for the workbench."""
    names = [f"motorcycle.vehicle.{vector}.{axis}" for vector in ("specificForce", "angularVelocity") for axis in "xyz"]
    names += [f"motorcycle.vehicle.orientation.{angle}" for angle in ANGLES]
    names += ["motorcycle.vehicle.speed", "motorcycle.rider.lean"]
    header = "time,ax,ay,az,wx,wy,wz,roll,pitch,yaw,speed,lean"
    # FMPy sets all connected inputs to zero in its first step; the motorcycle has none, and begins at rest.
    rows = np.column_stack([result[name] for name in ["time", *names]])
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.9g")
    print(f"wrote {path}")


def draw_result(path, result):
    def force(axis):
        return [
            ("desired", result[f"motorcycle.vehicle.specificForce.{axis}"], GREY),
            ("commanded", result[f"washout.rider.specificForce.{axis}"], ORANGE),
            ("felt", result[f"platform.rider.specificForce.{axis}"], BLUE),
        ]

    def degrees(name):
        return np.degrees(result[name])

    draw(path, "A lap with preview", result["time"], [
        ("motorcycle", [("speed [km/h]", 3.6 * result["speed"], "C2"), ("lean [°]", degrees("motorcycle.vehicle.orientation.roll"), "C4")]),
        ("specific force,\nsurge [m/s²]", force("x")),
        ("specific force,\nsway [m/s²]", force("y")),
        ("tilt [°]", [("pitch", degrees("washout.tilt.pitch"), BLUE), ("roll", degrees("washout.tilt.roll"), ORANGE)]),
        ("actuator length [m]", [(f"{i}", result[f"actuatorLength{i}"], None) for i in range(1, 7)] + [(None, 1.0, None), (None, 1.6, None)]),
    ])  # fmt: skip


def main():
    result = simulate()
    print_errors(result)
    draw_result("target/examples/10_lap.svg", result)
    write_recording("target/examples/lap.csv", result)


if __name__ == "__main__":
    main()
