"""The crate fmu-runner, by the small program around it in the directory fmu-runner."""

import subprocess
import sys

import report
from ride import Ride


def ride_with(fmu, ride, program):
    # The program reads what to set before each step and prints what it got after it.
    lines = [" ".join(ride.inputs), " ".join(ride.outputs), repr(ride.step)]
    lines += [" ".join(map(repr, ride.input(k))) for k in range(ride.steps)]
    done = subprocess.run([program, fmu], input="\n".join(lines) + "\n", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    answers = {k + 1: list(map(float, line.split())) for k, line in enumerate(done.stdout.splitlines())}
    return ride.difference(answers)


def main(fmus, program):
    for fmu in fmus:
        ride = Ride(fmu)
        # fmu-runner has no FMI 3.0.
        if ride.fmi == "2.0":
            report.ride(ride, ", and half of it again from a state", ride_with(fmu, ride, program))


if __name__ == "__main__":
    main(sys.argv[1].split(","), sys.argv[3])
