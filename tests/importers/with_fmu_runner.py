"""The crate fmu-runner, by the small program around it in the directory fmu-runner."""

import subprocess
import sys

import report
from ride import Ride


def main(fmu, program):
    ride = Ride(fmu)
    # The program reads what to set before each step and prints what it got after it.
    lines = [" ".join(ride.inputs), " ".join(ride.outputs), repr(ride.step)]
    lines += [" ".join(map(repr, ride.input(k))) for k in range(ride.steps)]
    done = subprocess.run([program, fmu], input="\n".join(lines) + "\n", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    answers = {k + 1: list(map(float, line.split())) for k, line in enumerate(done.stdout.splitlines())}
    report.difference("ride, and half of it again from a state", ride.difference(answers))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[3])
