"""The whole simulator as packages (SSP): where they are, and what has to come of a few seconds' acceleration."""

import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import report

SYSTEMS = ("MotorcycleSimulator", "MotorcycleLap")
STEP = 1e-3
STEPS = 5000
# The throttle, from its step on.
THROTTLE, OPENED_AT = 0.3, 1000
LEGS = [f"actuator[{i}].length" for i in range(1, 7)]
# A parameter of the washout that is not its own start value, and the name of the parameter sets.
PARAMETER, VALUE = "scale.specificForce.x", 0.65
PARAMETER_SET = "MotorcycleSimulator"


def packages(fmu, form="flat.ssp"):
    """The packages of this form beside the FMU: the simulator and the lap."""
    return [Path(fmu).with_name(f"{system}.{form}") for system in SYSTEMS]


def references(path, model):
    """Value references by name in one of a package's FMUs."""
    with zipfile.ZipFile(path) as outer, zipfile.ZipFile(io.BytesIO(outer.read(f"resources/{model}.fmu"))) as inner:
        description = ElementTree.fromstring(inner.read("modelDescription.xml"))
    return {v.get("name"): int(v.get("valueReference")) for v in description.iter("ScalarVariable")}


def judge(speed, lengths, parameter, what="the whole simulator, MotorcycleSimulator.flat.ssp"):
    """Says whether the motorcycle has gone off, the platform has followed, and the washout has its parameter."""
    reasons = []
    if not 5.0 < speed < 20.0:
        reasons.append(f"the speed is {speed} m/s")
    if not (all(1.0 < length < 1.6 for length in lengths) and max(lengths) - min(lengths) > 0.02):
        reasons.append(f"the actuators' lengths are {lengths} m")
    if abs(parameter - VALUE) > 1e-12:
        reasons.append(f"{PARAMETER} is {parameter}")
    report.check(what, not reasons, "; ".join(reasons), "SSP")


def judge_lap(real, integer, what="the lap, MotorcycleLap.flat.ssp"):
    """Says whether the motorcycle has gone off on its path, the washout has its preview, and the platform has followed.

    real, integer: functions that give the value of a component's variable.
    """
    reasons = []
    speed, deviation = real("motorcycle", "vehicle.speed"), real("motorcycle", "path.deviation")
    if not 8.0 < speed < 11.0:
        reasons.append(f"the speed is {speed} m/s")
    if not abs(deviation) < 0.1:
        reasons.append(f"the deviation from the path is {deviation} m")
    count = integer("washout", "vehicle.preview.count")
    last = [real(component, "vehicle.preview.specificForce.x[20]") for component in ("motorcycle", "washout")]
    if count != 20 or abs(last[1] - last[0]) > 0.01 or last[0] < 1.0:
        reasons.append(f"the washout's preview has {count} elements, and the last of both is {last}")
    felt = real("platform", "rider.specificForce.x")
    if not 1.9 < felt < 2.3:
        reasons.append(f"the felt surge is {felt} m/s2")
    report.check(what, not reasons, "; ".join(reasons), "SSP")
