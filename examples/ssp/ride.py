"""Ride the whole simulator in fmpy: a motorcycle, the washout filter and the Stewart platform, wired by SSP.

    cargo build-ssp
    python examples/ssp/ride.py --ssp target/fmu/MotorcycleSimulator.ssp --picture ride.png

The rider accelerates, rides a slalom and brakes to a stop. What he is commanded are the three inputs that the system has:
throttle, brake, and the lean to ride at.
"""

import argparse
from pathlib import Path

import numpy as np
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssv

DURATION = 45.0  # s
SLALOM = (14.0, 28.0)  # s
LEGS = range(1, 7)

# Times [s] and values between which the commands are linear.
THROTTLE = ([1.0, 3.0, 9.0, 12.0, 29.0, 30.0], [0.0, 0.3, 0.3, 0.1, 0.1, 0.0])
BRAKE = ([30.0, 33.0], [0.0, 0.25])


def throttle(t):
    return np.interp(t, *THROTTLE)


def brake(t):
    return np.interp(t, *BRAKE)


def lean(t):
    """The lean of a slalom, rad: to the right first, 15 degrees to either side, in 4 s from right to right."""
    begin, end = SLALOM
    fade = np.interp(t, [begin, begin + 2, end - 2, end], [0, 1, 1, 0])
    return np.radians(15) * fade * np.sin(2 * np.pi * (t - begin) / 4.0)


def ride(ssp, step=1e-3):
    """Rides with communication steps of `step` seconds. Returns the values of all connectors, a row a step, by name."""
    # fmpy sets parameters only where it is handed them; other tools take those that the system is bound to by themselves.
    parameters = read_ssv(ssp, "resources/MotorcycleSimulator.ssv")
    commands = {"throttle": throttle, "brake": brake, "lean": lean}
    result = simulate_ssp(ssp, stop_time=DURATION, step_size=step, parameter_set=parameters, input=commands)
    # In its first step fmpy gives zero to every connected input: a rider without weight. That is over after half a second.
    return result[result["time"] >= 0.5]


def legs(result, component, quantity):
    """A quantity of the six actuators, a column each."""
    return np.stack([result[f"{component}.actuator[{i}].{quantity}"] for i in LEGS], axis=1)


def draw(path, result):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    # The same picture from the same ride, to the byte.
    plt.rcParams |= {"svg.hashsalt": "ride", "svg.fonttype": "none", "font.family": "sans-serif"}
    result = result[:: max(1, len(result) // 500)]
    times = result["time"]
    figure, axes = plt.subplots(6, 1, figsize=(9, 13), sharex=True, layout="constrained")
    figure.suptitle("Accelerate, slalom, brake to a stop: motorcycle, washout and platform")

    axes[0].plot(times, 3.6 * result["motorcycle.vehicle.speed"], color="C2", label="speed [km/h]")
    axes[0].plot(times, np.degrees(result["motorcycle.vehicle.orientation.roll"]), color="C4", label="lean [°]")
    axes[0].set_ylabel("motorcycle")
    for axis, name, letter in zip(axes[1:3], ("surge", "sway"), "xy"):
        axis.plot(times, result[f"motorcycle.vehicle.specificForce.{letter}"], color="0.55", label="on the motorcycle")
        axis.plot(times, result[f"washout.rider.specificForce.{letter}"], color="C1", label="as the washout commands")
        axis.plot(times, result[f"platform.rider.specificForce.{letter}"], color="C0", label="on the platform", linewidth=1)
        axis.set_ylabel(f"specific force,\n{name} [m/s²]")
    axes[3].plot(times, np.degrees(result["motorcycle.vehicle.angularVelocity.x"]), color="0.55", label="on the motorcycle")
    axes[3].plot(times, np.degrees(result["platform.rider.angularVelocity.x"]), color="C0", label="on the platform", linewidth=1)
    axes[3].set_ylabel("roll rate [°/s]")
    axes[4].plot(times, legs(result, "platform", "length"), label=[f"actuator {i}" for i in LEGS], linewidth=1)
    for limit in (1.0, 1.6):
        axes[4].axhline(limit, color="black", linestyle="--", linewidth=1)
    axes[4].set_ylabel("actuator length [m]")
    axes[5].plot(times, legs(result, "platform", "force"), label=[f"actuator {i}" for i in LEGS], linewidth=1)
    axes[5].set_ylabel("actuator force [N]")
    axes[5].set_xlabel("time [s]")
    for axis in axes:
        axis.grid(alpha=0.3)
        axis.margins(y=0.25)
        axis.legend(loc="upper left", ncols=6, fontsize="small", frameon=False)
    figure.savefig(path, dpi=120, metadata={"Date": None} if Path(path).suffix == ".svg" else None)


def report(result):
    speed = result["motorcycle.vehicle.speed"]
    print(f"top speed {3.6 * speed.max():.0f} km/h, at the end {speed[-1]:g} m/s")
    for name, letter in (("surge", "x"), ("sway", "y"), ("heave", "z")):
        desired, commanded, felt = (
            result[f"{part}.specificForce.{letter}"] for part in ("motorcycle.vehicle", "washout.rider", "platform.rider")
        )
        print(
            f"{name}: RMS error of the felt specific force {rms(felt - desired):.3f} m/s2, of which the platform adds "
            f"{rms(felt - commanded):.3f} m/s2 to what the washout commands"
        )
    lengths, forces = legs(result, "platform", "length"), legs(result, "platform", "force")
    print(f"actuators: {lengths.min():.3f} to {lengths.max():.3f} m, {forces.min():.0f} to {forces.max():.0f} N")


def rms(values):
    return np.sqrt(np.mean(values**2))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--ssp", type=Path, default=Path("target/fmu/MotorcycleSimulator.ssp"), help="default: %(default)s"
    )
    parser.add_argument("--step", type=float, default=1e-3, help="communication step in seconds (default: %(default)s)")
    parser.add_argument("--picture", type=Path, help="write a picture of the ride, a PNG or SVG file")
    arguments = parser.parse_args()
    if not arguments.ssp.exists():
        parser.error(f"{arguments.ssp} is missing: run `cargo build-ssp`")
    result = ride(arguments.ssp, arguments.step)
    report(result)
    if arguments.picture:
        draw(arguments.picture, result)
        print(f"picture: {arguments.picture}")


if __name__ == "__main__":
    main()
