"""What the tests share: the FMU, and a thin wrapper that steps it."""

import importlib
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[2]
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
sys.path.append(str(ROOT / "tests"))
AXES = ("x", "y", "z")
ANGLES = ("roll", "pitch", "yaw")
only_all_cases = pytest.mark.skipif("MORIS_ALL_CASES" not in os.environ, reason="one of all cases: with --all")
"""For simulations of which the pages' commands print the result: here every step of it is looked at."""


def example(name):
    """An example in Python as a module."""
    sys.path.insert(0, str(ROOT / "examples"))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.pop(0)


def stated(variable, attribute):
    """An attribute as the variable or, for FMI 3.0's units, its declared type states it."""
    own = getattr(variable, attribute)
    return getattr(variable.declaredType, attribute) if own is None and variable.declaredType else own


@pytest.fixture(scope="session")
def fmu():
    path = Path(os.environ.get("MORIS_FMU", TARGET / "fmu" / "MorisWashout.fmu"))
    assert path.exists(), f"{path} is missing: run `cargo build-fmu`"
    return path


@pytest.fixture(scope="session")
def description(fmu):
    return read_model_description(fmu)


@pytest.fixture(scope="session")
def unpacked(fmu):
    directory = extract(fmu)
    yield directory
    shutil.rmtree(directory, ignore_errors=True)


@pytest.fixture
def washout(description, unpacked):
    """Makes initialised instances: washout(parameters) -> Washout."""
    made = []

    def make(**parameters):
        instance = Washout(description, unpacked, parameters.pop("parameters", {}))
        made.append(instance)
        return instance

    yield make
    for instance in made:
        instance.slave.freeInstance()


class Washout:
    """An instance of the FMU, by the names of its variables."""

    def __init__(self, description, unpacked, parameters=None):
        self.variables = {v.name: v for v in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=unpacked,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="test",
        )
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.set(parameters or {})
        self.slave.exitInitializationMode()
        self.time = 0.0

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def set(self, values):
        for name, value in values.items():
            variable = self.variables[name]
            reference = [variable.valueReference]
            if variable.type == "Real":
                self.slave.setReal(reference, [float(value)])
            elif variable.type == "Boolean":
                self.slave.setBoolean(reference, [bool(value)])
            else:
                self.slave.setInteger(reference, [int(value)])

    def get(self, *names):
        return np.array(self.slave.getReal(self.references(names)))

    def vector(self, name):
        return self.get(*(f"{name}.{axis}" for axis in AXES))

    def run(self, step, inputs, outputs, slopes=None):
        """Steps through `inputs`, a dict of name -> array; returns the outputs after each step, a row a step."""
        in_references = self.references(inputs)
        out_references = self.references(outputs)
        columns = np.column_stack(list(inputs.values()))
        slope_columns = None if slopes is None else np.column_stack([slopes[name] for name in inputs])
        rows = np.empty((len(columns), len(outputs)))
        start = self.time
        for k, row in enumerate(columns):
            self.slave.setReal(in_references, row.tolist())
            if slope_columns is not None:
                self.slave.setRealInputDerivatives(in_references, [1] * len(in_references), slope_columns[k].tolist())
            self.slave.doStep(start + k * step, step)
            rows[k] = self.slave.getReal(out_references)
        self.time = start + len(columns) * step
        return rows
