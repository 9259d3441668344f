"""fmi-sim, the simulator of rust-fmi."""

import subprocess
import sys
from pathlib import Path

import report
from ride import Ride


def ride_with(fmu, ride, work, program):
    input_file, result = work / "in.csv", work / "fmi_sim_out.csv"
    input_file.write_text(ride.input_text)
    command = [program, "--model", fmu, "--input-file", input_file, "--output-file", result]
    command += ["co-simulation", "-f", str(ride.stop), "--output-interval", str(ride.step)]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return ride.difference_of_table(result.read_text())


def main(fmus, work, program):
    for fmu in fmus:
        ride = Ride(fmu)
        report.ride(ride, "", ride_with(fmu, ride, work, program))


if __name__ == "__main__":
    main(sys.argv[1].split(","), Path(sys.argv[2]), sys.argv[3])
