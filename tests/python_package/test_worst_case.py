"""The example 14_worst_case.py: platforms off nominal behind the washout."""

import importlib
import sys

import moris
import numpy as np
import pytest
from conftest import ROOT, gentle

STEP = 1 / 500  # s, the example's


@pytest.fixture
def worst_case(fmu, monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "examples")
    monkeypatch.setitem(sys.modules, "14_worst_case", None)
    del sys.modules["14_worst_case"]
    example = importlib.import_module("14_worst_case")
    monkeypatch.setattr(example, "PLATFORM_FMU", fmu.parent / "StewartPlatform.fmu")
    return example


def felt_on(worst_case, simulation, **changed):
    parameters = worst_case.default_platform() | {name.replace("_", ".", 1): value for name, value in changed.items()}
    machine = worst_case.Machine(parameters)
    try:
        return machine.felt(("length", simulation["actuator.length"]), simulation["rider.lean"], STEP)
    finally:
        machine.close()


def test_a_machine_is_late_by_its_drives_and_its_dead_time(worst_case):
    simulation = moris.simulate(gentle(8.0), resample=500, strategy="classical")
    commanded = simulation["rider.specificForce"]
    # A drive of second order is late by 2 * damping / bandwidth: 8 ms, 4 commands.
    bandwidth = 2 * 0.5**0.5 / 0.008
    prompt, limited = felt_on(worst_case, simulation, actuator_bandwidth=bandwidth, actuator_deadTime=0.0)
    assert not any(limited)
    assert np.abs(prompt[504:] - commanded[500:-4]).max() < 0.002 < np.abs(prompt[500:] - commanded[500:]).max()
    late, _ = felt_on(worst_case, simulation, actuator_bandwidth=bandwidth, actuator_deadTime=0.05)
    assert np.abs(late[525:] - prompt[500:-25]).max() < 1e-9


def test_the_load_changes_nothing_until_a_drive_lacks_force(worst_case):
    simulation = moris.simulate(gentle(8.0), resample=500, strategy="classical")
    nominal, _ = felt_on(worst_case, simulation)
    platform = worst_case.with_point(worst_case.default_platform(), (1.5, 1.0, 0.004))
    assert platform["platform.mass"] == 375.0 and platform["rider.inertia.xx"] == 9.0 and platform["payload.mass"] == 0.0
    heavy, limited = felt_on(worst_case, simulation, **{name.replace(".", "_", 1): value for name, value in platform.items()})
    assert np.abs(heavy - nominal).max() < 1e-8 and not any(limited)
    with pytest.raises(Exception, match="fmi2"):
        felt_on(worst_case, simulation, actuator_forceLimit=500.0)


def test_figures_are_those_of_the_definitions(worst_case):
    time = np.arange(0.0, 10.0 + STEP / 2, STEP)
    fade = np.clip(np.minimum(time, 10.0 - time), 0, 1)
    forces = {"ax": 0.5 * fade * np.sin(time), "ay": 1.5 * fade * np.sin(2 * time)}
    recording = moris.Recording({"time": time, **forces}, missing="rest", fade_in=0.0)
    desired = np.column_stack([*forces.values(), np.full(len(time), 9.80665)])
    error, shake, jolt = worst_case.figures([(recording, desired, desired + [0.1, 0.4, 0.0])])
    assert error == pytest.approx((0.1 * 0.4) ** 0.5, rel=1e-9)
    assert shake < 1e-6 and jolt < 1e-6
    # Errors below 0.03 m/s2 count as that, and a channel on which nothing is desired does not count.
    still = moris.Recording({"time": time, "ax": 0 * time, "ay": forces["ay"]}, missing="rest", fade_in=0.0)
    without_surge = desired * [0, 1, 1]
    assert worst_case.figures([(still, without_surge, without_surge)])[0] == pytest.approx(0.03)
    with pytest.raises(SystemExit, match="take one with motion"):
        nothing = moris.Recording({"time": time, "ax": 0 * time, "ay": 0 * time}, missing="rest", fade_in=0.0)
        worst_case.figures([(nothing, desired * [0, 0, 1], desired)])


def test_machines_are_the_combinations_and_then_random_ones_of_the_seed(worst_case):
    platform = worst_case.default_platform()
    some = worst_case.machines(platform, 50, 1)
    assert len(some) == len(set(some)) == 77 and some[0] == (1.0, 1.0, 0.004) and (1.5, 0.7, 0.05) in some
    assert all(0.5 <= load <= 1.5 and 0.7 <= bandwidth <= 1.3 and 0 <= dead <= 0.05 for load, bandwidth, dead in some)
    other = worst_case.machines(platform, 50, 2)
    assert some[:27] == other[:27] and not set(some[27:]) & set(other[27:])
    with pytest.raises(SystemExit, match="at most 0.05 s"):
        worst_case.machines(platform | {"actuator.deadTime": 0.5}, 0, 1)
