"""OMSimulator, by its library's C functions: the reference rides, and the whole simulator in both forms."""

import sys
from ctypes import CDLL, byref, c_char_p, c_double, c_int
from pathlib import Path

import report
import simulator
from ride import Ride

WEAKLY_COUPLED = 1  # oms_system_wc


class OMSimulator:
    """The functions, which end with 0 (ok) or 1 (a warning) where they succeed."""

    def __init__(self, library, work):
        self.library = CDLL(str(library))
        self.call("oms_setTempDirectory", str(work))

    def call(self, function, *arguments):
        arguments = [argument.encode() if isinstance(argument, str) else argument for argument in arguments]
        status = getattr(self.library, function)(*arguments)
        assert status in (0, 1), f"{function}{arguments} returned {status}"

    def get(self, name):
        value = c_double()
        self.call("oms_getReal", name, byref(value))
        return value.value

    def get_integer(self, name):
        value = c_int()
        self.call("oms_getInteger", name, byref(value))
        return value.value

    def set(self, name, value):
        self.call("oms_setReal", name, c_double(value))

    def start(self, model):
        self.call("oms_setResultFile", model, "", 0)
        self.call("oms_instantiate", model)
        self.call("oms_initialize", model)

    def stop(self, model):
        self.call("oms_terminate", model)
        self.call("oms_delete", model)


def ride_with(oms, fmu, ride):
    """Makes the reference ride with the FMU as the only element of a system; returns the largest difference."""
    oms.call("oms_newModel", "ride")
    oms.call("oms_addSystem", "ride.root", WEAKLY_COUPLED)
    oms.call("oms_setFixedStepSize", "ride.root", c_double(ride.step))
    oms.call("oms_addSubModel", "ride.root.fmu", str(fmu))
    oms.call("oms_setStopTime", "ride", c_double(ride.stop))
    oms.start("ride")

    def set_inputs(values):
        for name, value in zip(ride.inputs, values):
            oms.set(f"ride.root.fmu.{name}", value)

    largest = ride.replay(
        set_inputs,
        # One step: it makes whole ones until it is past the time, which it has by adding up steps.
        lambda k: oms.call("oms_stepUntil", "ride", c_double(ride.time(k) + 0.5 * ride.step)),
        lambda: [oms.get(f"ride.root.fmu.{name}") for name in ride.outputs],
    )
    oms.stop("ride")
    return largest


def accelerate(oms, package, throttle):
    model = c_char_p()
    oms.call("oms_importFile", str(package), byref(model))
    model = model.value.decode()
    oms.call("oms_setStopTime", model, c_double(simulator.STEP * simulator.STEPS))
    oms.start(model)
    oms.call("oms_stepUntil", model, c_double(simulator.STEP * simulator.OPENED_AT))
    oms.set(f"{model}.simulator.{throttle}", simulator.THROTTLE)
    oms.call("oms_stepUntil", model, c_double(simulator.STEP * simulator.STEPS))
    values = lambda component, names: [oms.get(f"{model}.simulator.{component}.{name}") for name in names]
    simulator.judge(
        values("motorcycle", ["vehicle.speed"])[0],
        values("platform", simulator.LEGS),
        values("washout", [simulator.PARAMETER])[0],
        f"the whole simulator, {package.name}",
    )
    if throttle == "throttle":
        outputs = {"speed": "motorcycle.vehicle.speed", "feltSpecificForceX": "platform.rider.specificForce.x"}
        got = {name: oms.get(f"{model}.simulator.{name}") for name in outputs}
        wanted = {name: oms.get(f"{model}.simulator.{inside}") for name, inside in outputs.items()}
        report.check("and its own outputs", got == wanted and got["speed"] > 0.0, f"{got}, not {wanted}", "SSP")
    oms.stop(model)


def ride_the_lap(oms, package):
    model = c_char_p()
    oms.call("oms_importFile", str(package), byref(model))
    model = model.value.decode()
    oms.call("oms_setStopTime", model, c_double(simulator.STEP * simulator.STEPS))
    oms.start(model)
    oms.call("oms_stepUntil", model, c_double(simulator.STEP * simulator.STEPS))
    simulator.judge_lap(
        lambda component, variable: oms.get(f"{model}.simulator.{component}.{variable}"),
        lambda component, variable: oms.get_integer(f"{model}.simulator.{component}.{variable}"),
        f"the lap, {package.name}",
    )
    oms.stop(model)


def main(fmus, work, library):
    oms = OMSimulator(library, work)
    for fmu in fmus:
        ride = Ride(fmu)
        report.ride(ride, "", ride_with(oms, fmu, ride))
    for name, throttle in (("MotorcycleSimulator.ssp", "throttle"), ("MotorcycleSimulator.flat.ssp", "motorcycle.command.throttle")):
        package = Path(fmus[0]).with_name(name)
        if package.exists():
            accelerate(oms, package, throttle)
    for form in ("ssp", "flat.ssp"):
        ride_the_lap(oms, Path(fmus[0]).with_name(f"MotorcycleLap.{form}"))


if __name__ == "__main__":
    main(sys.argv[1].split(","), Path(sys.argv[2]), sys.argv[3])
