"""libcosim, the Open Simulation Platform's engine, by its Python package."""

import sys

import report
import simulator
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
from ride import Ride

NANOSECONDS = 1e9


def accelerate(package):
    execution = CosimExecution.from_ssp_file(ssp_path=str(package), step_size=int(simulator.STEP * NANOSECONDS))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    throttle = simulator.references(package, "Motorcycle")["command.throttle"]
    for k in range(simulator.STEPS):
        if k == simulator.OPENED_AT:
            index = execution.slave_index_from_instance_name("motorcycle")
            manipulator.slave_real_values(index, [throttle], [simulator.THROTTLE])
        assert execution.step(), "a step failed"

    def values(component, model, names):
        references = simulator.references(package, model)
        index = execution.slave_index_from_instance_name(component)
        return observer.last_real_values(index, [references[name] for name in names])

    simulator.judge(
        values("motorcycle", "Motorcycle", ["vehicle.speed"])[0],
        values("platform", "StewartPlatform", simulator.LEGS),
        values("washout", "MorisWashout", [simulator.PARAMETER])[0],
    )


def ride_the_lap(package):
    execution = CosimExecution.from_ssp_file(ssp_path=str(package), step_size=int(simulator.STEP * NANOSECONDS))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    for _ in range(simulator.STEPS):
        assert execution.step(), "a step failed"

    def value(read):
        def of(component, variable):
            model = {"motorcycle": "Motorcycle", "washout": "MorisWashout", "platform": "StewartPlatform"}[component]
            index = execution.slave_index_from_instance_name(component)
            return read(index, [simulator.references(package, model)[variable]])[0]

        return of

    simulator.judge_lap(value(observer.last_real_values), value(observer.last_integer_values))


def ride_with(fmu, ride):
    execution = CosimExecution.from_step_size(step_size=ride.step * NANOSECONDS)
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=fmu, instance_name="fmu"))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    inputs = [ride.references[name] for name in ride.inputs]
    outputs = [ride.references[name] for name in ride.outputs]

    def step(_):
        assert execution.step(), "a step failed"

    return ride.replay(
        lambda values: manipulator.slave_real_values(slave, inputs, values),
        step,
        lambda: observer.last_real_values(slave, outputs),
    )


def main(fmus):
    for fmu in fmus:
        ride = Ride(fmu)
        # libcosim has no FMI 3.0.
        if ride.fmi == "2.0":
            report.ride(ride, "", ride_with(fmu, ride))
    whole, lap = simulator.packages(fmus[0])
    accelerate(whole)
    ride_the_lap(lap)


if __name__ == "__main__":
    main(sys.argv[1].split(","))
