"""The FMU manipulation toolbox: its checks, and the washout inside a container FMU, which FMPy then runs."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import report
from fmpy import simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu
from ride import Ride

TOOLS = Path(sys.executable).parent


def tool(name, *arguments):
    """Runs one of the toolbox's programs; returns what it says."""
    done = subprocess.run([TOOLS / name, *arguments], capture_output=True, text=True)
    said = done.stdout + done.stderr
    assert done.returncode == 0, f"{name} failed: {said}"
    return said


def complaints(said):
    """The lines of the toolbox's log that warn or worse."""
    return [line for line in said.splitlines() if line.startswith(("WARNING", "ERROR", "CRITICAL"))]


def checks(fmu):
    found = complaints(tool("fmutool", "-input", fmu, "-check"))
    report.check(f"{Path(fmu).name}: fmutool -check", not found, "; ".join(found[:3]))


def container(fmu, work, ride):
    """Puts the FMU into a container and rides with that."""
    fmu = Path(fmu)
    specification = work / "container.csv"
    rows = ["rule;from_fmu;from_port;to_fmu;to_port"]
    rows += [f"FMU;{fmu.name};;;"]
    rows += [f"INPUT;;{name};{fmu.name};{name}" for name in ride.inputs]
    rows += [f"OUTPUT;{fmu.name};{name};;{name}" for name in ride.outputs]
    specification.write_text("\n".join(rows) + "\n")
    embedded = work / fmu.name
    embedded.write_bytes(fmu.read_bytes())
    built = work / "container.fmu"
    built.unlink(missing_ok=True)
    tool("fmucontainer", "-fmu-directory", work, "-container", f"{specification}:{ride.step}")
    problems = validate_fmu(str(built))
    assert not problems, problems
    (work / "in.csv").write_text(ride.input_text)
    result = simulate_fmu(
        str(built), input=read_csv(str(work / "in.csv")), stop_time=ride.stop, output_interval=ride.step, output=ride.outputs
    )
    rows = np.column_stack([result[name] for name in ride.outputs])
    return ride.difference({round(time / ride.step): row.tolist() for time, row in zip(result["time"], rows)})


def joined(fmus, work):
    """Puts three models into a container, joined by three lines between terminals; says whether the platform moves."""
    names = [Path(fmu).name for fmu in fmus]
    washout, motorcycle, platform = names
    lines = [
        (motorcycle, "vehicle", washout, "vehicle"),
        (washout, "actuators", platform, "actuators"),
        (motorcycle, "rider", platform, "rider"),
    ]
    rows = ["rule;from_fmu;from_port;to_fmu;to_port"]
    rows += [f"FMU;{name};;;" for name in (motorcycle, washout, platform)]
    rows += [f"LINK;{';'.join(line)}" for line in lines]
    rows += [f"INPUT;;throttle;{motorcycle};command.throttle", f"OUTPUT;{platform};actuator[1].length;;length"]
    specification = work / "joined.csv"
    specification.write_text("\n".join(rows) + "\n")
    for fmu in fmus:
        (work / Path(fmu).name).write_bytes(Path(fmu).read_bytes())
    said = tool("fmucontainer", "-fmu-directory", work, "-container", f"{specification}:0.001")
    ride = np.array([(0.0, 0.0), (1.0, 0.3), (5.0, 0.3)], dtype=[("time", float), ("throttle", float)])
    result = simulate_fmu(str(work / "joined.fmu"), input=ride, stop_time=5.0, output_interval=0.01, output=["length"])
    moved = float(np.ptp(result["length"]))
    version = Ride(fmus[0]).fmi
    what = f"three models joined by three terminals, FMI {version}"
    report.check(what, moved > 0.02, f"the actuator moves by {moved} m; {complaints(said)[:2]}", version)


def main(fmus, work):
    os.chdir(work)
    # Those of FMI 2.0 have no terminals.
    joined(fmus[3:], work)
    for fmu in fmus:
        ride = Ride(fmu)
        checks(fmu)
        report.ride(ride, " inside a container, in FMPy", container(fmu, work, ride))


if __name__ == "__main__":
    main(sys.argv[1].split(","), Path(sys.argv[2]))
