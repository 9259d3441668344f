"""fmuloader, a thin layer of Python over the C functions of both versions."""

import sys
import zipfile
from pathlib import Path

import report
from fmuloader.fmi2 import Fmi2Slave, Fmi2Type
from fmuloader.fmi3 import Fmi3Slave
from ride import Ride


def fmi2_slave(ride, location):
    slave = Fmi2Slave(location, model_identifier=ride.model)
    slave.instantiate("ride", Fmi2Type.CO_SIMULATION, guid=ride.guid)
    slave.setup_experiment(start_time=0.0, stop_time=ride.stop)
    slave.enter_initialization_mode()
    return slave, slave.set_real, slave.get_real


def fmi3_slave(ride, location):
    slave = Fmi3Slave(location, model_identifier=ride.model)
    slave.instantiate_co_simulation("ride", instantiation_token=ride.guid)
    slave.enter_initialization_mode(start_time=0.0, stop_time=ride.stop)
    return slave, slave.set_float64, slave.get_float64


def ride_with(ride, location):
    slave, set_reals, get_reals = (fmi2_slave if ride.fmi == "2.0" else fmi3_slave)(ride, location)
    slave.exit_initialization_mode()
    inputs, outputs = ([ride.references[name] for name in names] for names in (ride.inputs, ride.outputs))
    largest = ride.replay(
        lambda values: set_reals(inputs, values),
        lambda k: slave.do_step(ride.time(k), ride.step),
        lambda: list(get_reals(outputs)),
    )
    slave.terminate()
    slave.free_instance()
    return largest


def main(fmus, work):
    for fmu in fmus:
        ride = Ride(fmu)
        location = work / Path(fmu).stem
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(location)
        report.ride(ride, "", ride_with(ride, location))


if __name__ == "__main__":
    main(sys.argv[1].split(","), Path(sys.argv[2]))
