"""Measures each strategy on platforms that differ from the nominal one, and prints the tables of docs/worst-case.md.

    cargo build-fmu
    python3 examples/14_worst_case.py RECORDINGS... [--strategy NAMES] [--points NUMBER] [--rig FILE] [--platform FILE]

The washout's legs or cranks command StewartPlatform.fmu, a platform with dynamics; the washout gets no feedback. Machines have 50 to
150 % of the load, 70 to 130 % of the bandwidth and 0 to 50 ms of dead time. All combinations of nominal, least and largest are
tried, then random points. Needs the package `moris`, FMPy and NumPy.
"""

import argparse
import itertools
import shutil
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import moris
import numpy as np
import tomllib
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

PLATFORM_FMU = "target/fmu/StewartPlatform.fmu"
STRATEGIES = ["classical", "adaptive", "optimal", "predictive", "robust"]
COMMAND_RATE = 500  # commands to the legs a second
LOADS, BANDWIDTHS, DEAD_TIMES = (0.5, 1.5), (0.7, 1.3), (0.0, 0.05)  # multiples of the nominal, and s
LEAST_DESIRED_FORCE = 0.03  # RMS of a channel that counts, and least error [m/s²]
FELT = [f"rider.specificForce.{axis}" for axis in "xyz"]
MASSES = ["platform.mass", "rider.mass", "payload.mass"]
INERTIAS = [f"{part}.inertia.{element}" for part in ("platform", "rider") for element in ("xx", "yy", "zz", "xy", "xz", "yz")]
ERROR, SHAKE, JOLT = range(3)
OF_RIG = ("rig.", "head.", "crank.", "actuator.minLength", "actuator.maxLength")  # parameters that the washout's rig gives the platform


class Machine:
    """StewartPlatform.fmu with these parameters, and the rider on it."""

    def __init__(self, parameters):
        self.directory = extract(PLATFORM_FMU)
        description = read_model_description(self.directory)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid, unzipDirectory=self.directory, modelIdentifier="StewartPlatform", instanceName="platform"
        )
        self.fmu.instantiate()
        values = {name: value for name, value in parameters.items() if name in self.references}
        self.fmu.setReal([self.references[name] for name in values], list(values.values()))

    def felt(self, commanded, leans, step):
        """Specific force that the rider feels at each command (N, 3) [m/s²], and whether speed or force was limited."""
        quantity, positions = commanded
        inputs = [self.references[name] for name in (*(f"command[{leg}].{quantity}" for leg in range(1, 7)), "rider.lean")]
        outputs = [self.references[name] for name in FELT]
        flags = [self.references[f"status.{name}"] for name in ("driveLimited", "forceLimited", "atStop")]
        commands = np.column_stack([positions, leans])
        slopes = np.diff(commands, axis=0) / step
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.setReal(inputs, commands[0].tolist())
        self.fmu.exitInitializationMode()
        felt, limited = [self.fmu.getReal(outputs)], np.zeros(3, bool)
        for k, slope in enumerate(slopes):
            self.fmu.setReal(inputs, commands[k].tolist())
            self.fmu.setRealInputDerivatives(inputs, [1] * len(inputs), slope.tolist())
            self.fmu.doStep(currentCommunicationPoint=k * step, communicationStepSize=step)
            felt.append(self.fmu.getReal(outputs))
            limited |= np.array(self.fmu.getBoolean(flags), bool)
        return np.array(felt), (limited[0], limited[1] or limited[2])

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.directory, ignore_errors=True)


def default_platform():
    """Start values of the FMU's parameters."""
    variables = read_model_description(PLATFORM_FMU).modelVariables
    return {variable.name: float(variable.start) for variable in variables if variable.causality == "parameter"}


def machines(platform, points, seed):
    """The load and the bandwidth, each as a multiple of the nominal one, and the dead time [s]; the first is nominal."""
    nominal = (1.0, 1.0, platform["actuator.deadTime"])
    if nominal[2] > DEAD_TIMES[1]:
        raise SystemExit(f"actuator.deadTime is {nominal[2]} s; give a platform with at most {DEAD_TIMES[1]} s")
    ranges = (LOADS, BANDWIDTHS, DEAD_TIMES)
    corners = list(itertools.product(*((value, *ends) for value, ends in zip(nominal, ranges, strict=True))))
    least, largest = np.transpose(ranges)
    random = np.random.default_rng(seed).uniform(least, largest, (points, 3))
    return corners + [tuple(map(float, point)) for point in random]


def with_point(platform, point):
    """The platform's parameters on a machine."""
    load, bandwidth, dead_time = point
    loaded = {name: load * platform[name] for name in MASSES + INERTIAS}
    return platform | loaded | {"actuator.bandwidth": bandwidth * platform["actuator.bandwidth"], "actuator.deadTime": dead_time}


def figures(rides):
    """Geometric mean of the RMS errors, largest shake and largest jolt of surge and sway over all rides [m/s²]."""
    errors, comforts = [], []
    for recording, desired, felt in rides:
        measures = moris.measure(recording, felt_force=felt).measures
        for k, axis in enumerate("xy"):
            if np.sqrt(np.mean(desired[:, k] ** 2)) >= LEAST_DESIRED_FORCE:
                errors.append(max(LEAST_DESIRED_FORCE, np.sqrt(np.mean((felt[:, k] - desired[:, k]) ** 2))))
            comforts.append([measures.get(f"specific force {axis} {name}") or 0.0 for name in ("shake", "jolt")])
    if not errors:
        raise SystemExit("no surge or sway of at least 0.03 m/s² (RMS) is desired on these recordings; take one with motion")
    return np.array([np.exp(np.mean(np.log(errors))), *np.max(comforts, axis=0)])


def on_machine(task):
    """A strategy's figures on a machine, and whether speed or force was limited on any ride."""
    files, strategy, rig, platform = task
    rides, limited = [], np.zeros(2, bool)
    for recording, simulation in commanded(files, strategy, rig):
        machine = Machine({name: value for name, value in simulation.parameters.items() if name.startswith(OF_RIG)} | platform)
        quantity = "angle" if simulation.parameters["crank.arm"] else "length"
        commands = quantity, simulation[f"actuator.{quantity}"]
        felt, found = machine.felt(commands, simulation["rider.lean"], 1 / COMMAND_RATE)
        machine.close()
        rides.append((recording, simulation["vehicle.specificForce"], felt))
        limited |= found
    return figures(rides), limited


def commanded(files, strategy, rig):
    """Each recording with the washout's commands."""
    for file in files:
        recording = moris.Recording(file, resample=COMMAND_RATE)
        yield recording, moris.simulate(recording, parameters={"strategy": strategy}, rig=rig)


def print_tables(strategies, points, results, own):
    print("| strategy | figure | commanded | nominal | worst | load | bandwidth | dead time |\n|---|---|---|---|---|---|---|---|")
    for strategy in strategies:
        found = np.array([figure for figure, _ in results[strategy]])
        for measure, (name, decimals) in enumerate((("RMS error", 3), ("shake", 2), ("jolt", 1))):
            # Without active limits the load has no effect: of equal machines the first is named.
            at = int(np.argmax(found[:, measure] > found[:, measure].max() * (1 - 1e-6)))
            load, bandwidth, dead_time = points[at]
            values = (own[strategy][measure], found[0, measure], found[at, measure])
            shown = " | ".join(f"{value:.{decimals}f}" for value in values)
            title = "" if measure else f"`{strategy}`"
            print(f"| {title} | {name} | {shown} | {load:.0%} | {bandwidth:.0%} | {1e3 * dead_time:.1f} ms |".replace("%", " %"))
    print("\n| strategy | load | bandwidth | dead time | all | speed or stroke limited | force limited |\n|---|---|---|---|---|---|---|")
    for strategy in strategies:
        found = np.array([figure[ERROR] for figure, _ in results[strategy]])
        off = np.array(points) != np.array(points[0])
        alone = [found[(off == (np.arange(3) == k)).all(1) | ~off.any(1)].max() for k in range(3)]
        counts = np.sum([limited for _, limited in results[strategy]], axis=0)
        print(f"| `{strategy}` | " + " | ".join(f"{value:.3f}" for value in (*alone, found.max())) + f" | {counts[0]} | {counts[1]} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+", type=Path)
    parser.add_argument("--strategy", type=lambda names: names.split(","), default=STRATEGIES)
    parser.add_argument("--points", type=int, default=50, help="number of random points")
    parser.add_argument("--seed", type=int, default=1, help="seed of the random points")
    parser.add_argument("--rig", help="rig file")
    parser.add_argument("--platform", type=Path, help="parameter file of the nominal platform")
    options = parser.parse_args()
    files = [file for place in options.recordings for file in (sorted(place.glob("*.csv")) if place.is_dir() else [place])]
    platform = default_platform()
    given = tomllib.loads(options.platform.read_text()) if options.platform else {}
    if unknown := given.keys() - platform.keys():
        raise SystemExit(f"{options.platform}: StewartPlatform.fmu has no parameter {', '.join(sorted(unknown))}; write whole names, in quotes")
    # Rig and head are the washout's.
    platform = {name: value for name, value in (platform | given).items() if not name.startswith(OF_RIG)}
    points = machines(platform, options.points, options.seed)
    print(f"{len(files)} recordings, {len(points)} machines\n")
    results, own = {}, {}
    with ProcessPoolExecutor() as pool:
        for strategy in options.strategy:
            tasks = [(files, strategy, options.rig, with_point(platform, point)) for point in points]
            results[strategy] = list(pool.map(on_machine, tasks))
            rides = commanded(files, strategy, options.rig)
            own[strategy] = figures((recording, ride["vehicle.specificForce"], ride["rider.specificForce"]) for recording, ride in rides)
    print_tables(options.strategy, points, results, own)


if __name__ == "__main__":
    main()
