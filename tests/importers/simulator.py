"""The whole simulator as a package (SSP): where it is, and what has to come of a few seconds' acceleration."""

import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import report

STEP = 1e-3
STEPS = 5000
# The throttle, from its step on.
THROTTLE, OPENED_AT = 0.3, 1000
LEGS = [f"actuator[{i}].length" for i in range(1, 7)]
# A parameter of the washout that is not its own start value, and the name of the parameter sets.
PARAMETER, VALUE = "scale.specificForce.x", 0.65
PARAMETER_SET = "MotorcycleSimulator"


def package(fmu):
    """The package beside the FMU; none where it has not been built."""
    path = Path(fmu).with_name("MotorcycleSimulator.flat.ssp")
    return path if path.exists() else None


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
