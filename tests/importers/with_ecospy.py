"""Ecos, in this process and, by its proxyfmu, in another one."""

import os
import sys
from pathlib import Path

import ecospy
import report
import simulator
from ecospy.EcosSimulation import EcosSimulation
from ecospy.EcosSimulationStructure import EcosSimulationStructure
from ride import Ride

# proxyfmu reads 512 bytes of a reply, and crashes on what is longer: that many real outputs and its head fit.
OUTPUTS_OF_A_REPLY = 60


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


def accelerate(package):
    with EcosSimulation(ssp_path=str(package), step_size=simulator.STEP) as simulation:
        assert simulation.init(parameter_set=simulator.PARAMETER_SET), "the system cannot be initialized"
        for k in range(simulator.STEPS):
            if k == simulator.OPENED_AT:
                simulation.set_real("motorcycle::command.throttle", simulator.THROTTLE)
            simulation.step()
        simulator.judge(
            simulation.get_real("motorcycle::vehicle.speed"),
            [simulation.get_real(f"platform::{name}") for name in simulator.LEGS],
            simulation.get_real(f"washout::{simulator.PARAMETER}"),
        )
        simulation.terminate()


def ride_the_lap(package):
    with EcosSimulation(ssp_path=str(package), step_size=simulator.STEP) as simulation:
        assert simulation.init(), "the system cannot be initialized"
        for _ in range(simulator.STEPS):
            simulation.step()
        simulator.judge_lap(
            lambda component, variable: simulation.get_real(f"{component}::{variable}"),
            lambda component, variable: simulation.get_integer(f"{component}::{variable}"),
        )
        simulation.terminate()


def main(fmus):
    # The package forgets to mark its program as one.
    (Path(ecospy.__file__).parent / "binaries" / "proxyfmu").chmod(0o755)
    for fmu in fmus:
        ride = Ride(fmu)
        report.ride(ride, ", in process", ride_with(ride, fmu))
        short = ride.of_first_outputs(OUTPUTS_OF_A_REPLY)
        report.ride(ride, ", in another process (proxyfmu)", ride_with(short, f"proxyfmu://localhost?file={fmu}"))
    whole, lap = simulator.packages(fmus[0])
    accelerate(whole)
    ride_the_lap(lap)


if __name__ == "__main__":
    main(sys.argv[1].split(","))
    # Every simulation is over, and its FMUs are unloaded. One process in thirty then crashes as Ecos' own objects end.
    os._exit(0)
