"""The time of a step from Rust, from Python and through FMPy, side by side, and that of a sweep on one and two processes.

    python3 benches/python.py [--sweep]

Needs the package (`pip install .[dask]`), fmpy, and the FMU (`cargo build-fmu`). Each figure is the least of many short runs
that take turns, so that another load of the machine hardly counts.
"""

import argparse
import functools
import subprocess
import sys
import time
from pathlib import Path

import moris
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
FMU = ROOT / "target" / "fmu" / "MorisWashout.fmu"
STEPS = 5_000
STEP = 0.001
TURNS = 5
RUNS = 200


def samples(count):
    t = np.arange(count + 1) * STEP
    force = np.column_stack([np.sin(t), 0.5 * np.cos(t), 9.80665 + 0.1 * np.sin(3 * t)])
    rate = np.column_stack([0.1 * np.cos(t), 0 * t, 0.1 * np.sin(t)])
    return t, force, rate


def seconds(function, *arguments):
    begin = time.perf_counter()
    function(*arguments)
    return time.perf_counter() - begin


def rust(profile):
    """The Rust program, built once; returns a function that gives its time of a step [ns]."""
    build = ["cargo", "build", "--profile", profile, "-p", "moris-simulation", "--example", "one_run"]
    subprocess.run(build, cwd=ROOT, check=True)
    program = ROOT / "target" / profile / "examples" / "one_run"
    return lambda: float(subprocess.run([program, str(STEPS)], check=True, capture_output=True, text=True).stdout)


def least(run, runs=RUNS):
    return min(run() for _ in range(runs))


def arrays():
    given = samples(STEPS)
    return lambda: least(lambda: 1e9 * seconds(lambda: moris.Washout().run(*given)) / STEPS)


def single_steps():
    count = STEPS // 10
    _, force, rate = samples(count)
    inputs = [(tuple(f), tuple(w)) for f, w in zip(force.tolist(), rate.tolist())]

    def run():
        step = moris.Washout().step
        begin = time.perf_counter()
        for f, w in inputs:
            step(STEP, f, w)
        return 1e9 * (time.perf_counter() - begin) / count

    return lambda: least(run)


def fmpy():
    """simulate_fmu with an array of inputs: the FMU's step with what FMPy adds to it."""
    import fmpy

    count = STEPS // 5
    t, force, rate = samples(count)
    names = [f"vehicle.{quantity}.{axis}" for quantity in ("specificForce", "angularVelocity") for axis in "xyz"]
    table = np.rec.fromarrays([t, *force.T, *rate.T], names=["time", *names])
    folder = fmpy.extract(str(FMU))
    description = fmpy.read_model_description(folder)
    outputs = [f"actuator[{leg}].length" for leg in range(1, 7)]

    def run():
        begin = time.perf_counter()
        fmpy.simulate_fmu(
            folder, model_description=description, input=table, output=outputs, stop_time=count * STEP, output_interval=STEP
        )
        return 1e9 * (time.perf_counter() - begin) / count

    return lambda: least(run, 3)


def table():
    kinds = {
        "Rust, `moris_simulation::Replay`, profile of the FMU": rust("fmu-library"),
        "Rust, the same, profile of the package": rust("release"),
        "Python, `Washout.run` on arrays": arrays(),
        "Python, `Washout.step` one by one": single_steps(),
        "FMPy, `simulate_fmu` with six outputs": fmpy(),
    }
    found = dict.fromkeys(kinds, float("inf"))
    for _ in range(TURNS):
        for name, run in kinds.items():
            found[name] = min(found[name], run())
    first = next(iter(found.values()))
    print("| way | time of a step [ns] | speed over Rust |\n|---|---|---|")
    for name, value in found.items():
        print(f"| {name} | {value:.0f} | {first / value:.2f} |")


def processor_time(client):
    """Processor time of the workers, and of this process, in which the scheduler runs, too [s]."""
    return np.array([sum(client.run(time.process_time).values()), time.process_time()])


def sweeps():
    from distributed import Client, LocalCluster

    t, force, rate = samples(6000)
    ride = {"time": 10 * t, "ax": force[:, 0], "ay": force[:, 1], "az": force[:, 2]}
    ride.update({"wx": rate[:, 0], "wy": rate[:, 1], "wz": rate[:, 2]})
    recording = moris.Recording(ride)
    sets = [{"splitter.x.omega1": 1.0 + 0.01 * k} for k in range(300)]
    times = {1: float("inf"), 2: float("inf")}
    spent = {workers: np.full(2, np.inf) for workers in times}
    for _ in range(3):
        for workers in times:
            with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as made, Client(made) as client:
                sweep = functools.partial(moris.sweep, recording, executor=client.get_executor(), workers=workers)
                sweep(sets[:20])
                before = processor_time(client)
                times[workers] = min(times[workers], seconds(functools.partial(sweep, sets)))
                spent[workers] = np.minimum(spent[workers], processor_time(client) - before)
    print(f"one process {times[1]:.2f} s, two {times[2]:.2f} s: {times[1] / times[2]:.2f} times as fast")
    for workers, (theirs, ours) in spent.items():
        print(f"processor time with {workers}: workers {theirs:.2f} s, client and scheduler {ours:.2f} s")
    # Two processors that nothing else uses share the work of both.
    print(f"from the processor times on two free cores: {2 * spent[1][0] / spent[2].sum():.2f} times as fast")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Measures the Python package.")
    parser.add_argument("--sweep", action="store_true", help="measure sweeps on one and two processes instead")
    sweeps() if parser.parse_args().sweep else table()
    sys.exit(0)
