"""Ecos, in this process and, by its proxyfmu, in another one."""

import sys
from pathlib import Path

import ecospy
from ecospy.EcosSimulation import EcosSimulation
from ecospy.EcosSimulationStructure import EcosSimulationStructure

import report
from ride import Ride


def ride_with(ride, location):
    with EcosSimulationStructure() as structure:
        structure.add_model("washout", location)
        with EcosSimulation(structure=structure, step_size=ride.step) as simulation:
            assert simulation.init(), "the simulation cannot be initialized"

            def set_inputs(values):
                for name, value in zip(ride.inputs, values):
                    simulation.set_real(f"washout::{name}", value)

            largest = ride.replay(
                set_inputs,
                lambda _: simulation.step(),
                lambda: [simulation.get_real(f"washout::{name}") for name in ride.outputs],
            )
            simulation.terminate()
            return largest


def main(fmu):
    ride = Ride(fmu)
    report.difference("ride, in process", ride_with(ride, fmu))
    # The package forgets to mark its program as one.
    (Path(ecospy.__file__).parent / "binaries" / "proxyfmu").chmod(0o755)
    report.difference("ride, in another process (proxyfmu)", ride_with(ride, f"proxyfmu://localhost?file={fmu}"))


if __name__ == "__main__":
    main(sys.argv[1])
