"""The class Washout: the FMU's numbers, states, arrays and errors."""

import copy
import pickle
import re
import threading
import time as clock
import warnings

import moris
import numpy as np
import pytest
from conftest import ROOT, STANDARD_GRAVITY, gentle
from fmpy import read_model_description
from fmpy.fmi2 import FMU2Slave

STEP = 2.0**-7
"""A power of two: samples of few bits have slopes without rounding."""


def few_bits(values, bits=20):
    """Values rounded to multiples of 2^-bits, so that differences and sums of them are exact."""
    return np.round(np.asarray(values) * 2.0**bits) / 2.0**bits


def samples(count=1500):
    """Specific force, angular velocity, orientation, speed and lean, all of few bits."""
    t = np.arange(count) * STEP
    force = np.column_stack([1.5 * np.sin(0.7 * t), 1.2 * np.cos(0.9 * t), STANDARD_GRAVITY + np.sin(3 * t)])
    rate = np.column_stack([0.3 * np.sin(t), 0.2 * np.cos(1.3 * t), 0.4 * np.sin(0.4 * t)])
    angles = 0.2 * np.column_stack([np.sin(0.3 * t), np.sin(0.5 * t), np.cos(0.2 * t)])
    speed, lean = 20.0 + np.sin(t), 0.1 * np.sin(0.8 * t)
    return t, *(few_bits(array) for array in (force, rate, angles, speed, lean))


INPUTS = [
    *(f"vehicle.specificForce.{axis}" for axis in "xyz"),
    *(f"vehicle.angularVelocity.{axis}" for axis in "xyz"),
    *(f"vehicle.orientation.{angle}" for angle in ("roll", "pitch", "yaw")),
    "vehicle.speed",
    "rider.lean",
]


def through_the_fmu(fmu, unpacked, parameters, rows, slopes, previews=None):
    """The outputs of the FMU in fmpy at each sample, by name; with input derivatives if `slopes`.

    previews: (N, K, 2), as of each sample.
    """
    description = read_model_description(str(fmu))
    variables = {variable.name: variable for variable in description.modelVariables}
    outputs = [v for v in description.modelVariables if v.causality == "output"]
    slave = FMU2Slave(
        guid=description.guid,
        unzipDirectory=unpacked,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="compared",
    )
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    references = [variables[name].valueReference for name in INPUTS]
    for name, value in parameters.items():
        variable = variables[name]
        if variable.type == "Real":
            slave.setReal([variable.valueReference], [value])
        else:
            items = [item.name for item in variable.declaredType.items]
            slave.setInteger([variable.valueReference], [items.index(value) + 1])
    slave.setReal(references, rows[0].tolist())
    slave.exitInitializationMode()

    def get():
        values = {}
        for kind, function in (("Real", slave.getReal), ("Boolean", slave.getBoolean), ("Integer", slave.getInteger)):
            of_kind = [v for v in outputs if v.type == kind]
            values.update(zip((v.name for v in of_kind), function([v.valueReference for v in of_kind])))
        return values

    found = [get()]
    if previews is not None:
        count = previews.shape[1]
        slave.setInteger([variables["vehicle.preview.count"].valueReference], [count])
        elements = [f"vehicle.preview.specificForce.{axis}[{k + 1}]" for k in range(count) for axis in "xy"]
        elements = [variables[name].valueReference for name in elements]
    for k in range(len(rows) - 1):
        slave.setReal(references, rows[k].tolist())
        if previews is not None:
            slave.setReal(elements, previews[k].ravel().tolist())
        if slopes:
            slope = (rows[k + 1] - rows[k]) / STEP
            slave.setRealInputDerivatives(references, [1] * len(references), slope.tolist())
        slave.doStep(k * STEP, STEP)
        found.append(get())
    slave.terminate()
    slave.freeInstance()
    return {name: np.array([row[name] for row in found]) for name in found[0]}


@pytest.mark.parametrize("slopes", [True, False])
@pytest.mark.parametrize(
    "parameters",
    [{}, {"strategy": "adaptive"}, {"strategy": "optimal", "splitter.x.omega1": 1.5, "tilt.rateLimit": 0.03}, {"strategy": "predictive"}],
    ids=["default", "adaptive", "optimal", "predictive"],
)
def test_arrays_give_the_fmus_outputs_to_the_bit(fmu, unpacked, parameters, slopes):
    t, force, rate, angles, speed, lean = samples()
    expected = through_the_fmu(fmu, unpacked, parameters, np.column_stack([force, rate, angles, speed, lean]), slopes)
    washout = moris.Washout(parameters=parameters)
    found = washout.run(t, force, rate, angles, speed, lean, inputs="slopes" if slopes else "values")
    assert set(found) == set(expected)
    for name in expected:
        assert np.array_equal(found[name], expected[name]), name
    assert np.ptp(found["actuator[1].length"]) > 0.01


def previews_of(force, elements=6, apart=20):
    """The x and y of the force to come as of each sample, elements 20 samples apart; the last one goes on."""
    ahead = np.arange(len(force))[:, None] + apart * np.arange(1, elements + 1)
    return force[np.minimum(ahead, len(force) - 1), :2]


@pytest.mark.parametrize("slopes", [True, False])
def test_a_preview_gives_the_fmus_outputs_to_the_bit(fmu, unpacked, slopes):
    t, force, rate, angles, speed, lean = samples(800)
    rows, previews = np.column_stack([force, rate, angles, speed, lean]), previews_of(force)
    parameters = {"strategy": "predictive"}
    expected = through_the_fmu(fmu, unpacked, parameters, rows, slopes, previews)
    inputs = "slopes" if slopes else "values"
    found = moris.Washout(parameters=parameters).run(t, force, rate, angles, speed, lean, preview=previews, inputs=inputs)
    for name in expected:
        assert np.array_equal(found[name], expected[name]), name
    without = moris.Washout(parameters=parameters).run(t, force, rate, angles, speed, lean, inputs=inputs)
    assert np.abs(without["platform.position"] - found["platform.position"]).max() > 0.01


def test_single_steps_with_previews_are_those_of_an_array():
    t, force, rate, *_ = samples(300)
    previews = previews_of(force)
    # Each is shorter than the one before: one that is NaN ends it.
    previews[100:, 3:] = np.nan
    run = moris.Washout(parameters="preview").run(t, force, rate, preview=previews, preview_step=0.15, inputs="values")
    washout = moris.Washout(parameters="preview")
    for k in range(len(t) - 1):
        given = previews[k] if k < 100 else previews[k, :3].tolist()
        output = washout.step(STEP, force[k], rate[k], preview=given, preview_step=0.15)
        assert output["actuator.length"] == tuple(run["actuator.length"][k + 1])
    other = moris.Washout(parameters="preview").run(t, force, rate, preview=previews, inputs="values")
    assert not np.array_equal(other.array, run.array)


def test_a_step_or_run_without_a_preview_has_none():
    t, force, rate, *_ = samples(200)
    washout = moris.Washout(parameters="preview")
    washout.run(t, force, rate, preview=previews_of(force))
    twin = washout.copy()
    empty = np.empty((len(t), 0, 2))
    assert np.array_equal(washout.run(t, force, rate).array, twin.run(t, force, rate, preview=empty).array)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"preview": np.zeros((50, 21, 2))}, moris.RecordingError, r"preview has the shape \(50, 21, 2\), but must have \(50, K, 2\), K at most 20"),
        ({"preview": np.zeros((49, 5, 2))}, moris.RecordingError, r"\(49, 5, 2\), but must have \(50, K, 2\)"),
        ({"preview": np.zeros((50, 5, 3))}, moris.RecordingError, r"\(50, 5, 3\), but must have \(50, K, 2\)"),
        ({"preview": "ahead"}, moris.RecordingError, "preview is no array of numbers"),
        ({"preview": np.zeros((50, 5, 2)), "preview_step": 0.0}, ValueError, "preview_step is 0 s, but must be from 0.01 to 10 s"),
    ],
)
def test_previews_that_do_not_fit_are_refused(arguments, error, message):
    t, force, *_ = samples(50)
    washout = moris.Washout(parameters="preview")
    with pytest.raises(error, match=message):
        washout.run(t, force, **arguments)
    assert washout == moris.Washout(parameters="preview")
    with pytest.raises(moris.RecordingError, match=r"preview has the shape \(20,\), but must have \(K, 2\)"):
        washout.step(0.01, preview=np.zeros(20))


def test_single_steps_are_those_of_an_array():
    t, force, rate, angles, speed, lean = samples(400)
    run = moris.Washout().run(t, force, rate, angles, speed, lean, inputs="values")
    washout = moris.Washout()
    for k in range(len(t) - 1):
        output = washout.step(STEP, force[k], tuple(rate[k]), angles[k], speed[k], lean[k])
        assert output["actuator.length"] == tuple(run["actuator.length"][k + 1])
        assert output["rider.specificForce.x"] == run["rider.specificForce.x"][k + 1]
    assert dict(output) == dict(washout.output) and washout["platform.position"] == output["platform.position"]


def test_a_run_goes_on_where_the_last_one_ended():
    t, force, rate, *_ = samples(600)
    whole = moris.Washout().run(t, force, rate)
    washout = moris.Washout()
    first = washout.run(t[:301], force[:301], rate[:301])
    second = washout.run(t[300:], force[300:], rate[300:])
    assert np.array_equal(np.vstack([first.array, second.array[1:]]), whole.array)
    assert np.array_equal(second.array[0], first.array[-1])


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, lambda w: pickle.loads(pickle.dumps(w)), lambda w: w.copy()])
@pytest.mark.parametrize("strategy", ["classical", "adaptive", "optimal", "robust", "predictive"])
def test_a_copied_state_goes_on_to_the_bit_and_apart(duplicate, strategy):
    t, force, rate, *_ = samples(500)
    original = moris.Washout(strategy=strategy)
    original.run(t[:251], force[:251], rate[:251])
    twin = duplicate(original)
    assert twin == original
    ahead = original.run(t[250:], force[250:], rate[250:])
    assert twin != original
    assert np.array_equal(twin.run(t[250:], force[250:], rate[250:]).array, ahead.array)


def test_a_damaged_state_is_refused():
    function, (state,) = moris.Washout().__reduce__()
    for wrong in (b"", state[:100], b"x" + state):
        with pytest.raises(ValueError, match="the state of a washout is rejected"):
            function(wrong)


def test_equal_steps_are_equal_to_the_bit_however_time_was_computed():
    _, force, rate, *_ = samples(500)
    exact = moris.Washout().run([0.0, *(0.001 * k for k in range(1, 500))], force, rate).array
    for time in (np.arange(500) * 0.001, np.cumsum(np.full(500, 0.001)), np.linspace(7.0, 7.499, 500)):
        assert np.array_equal(moris.Washout().run(time, force, rate).array, exact)


def test_unequal_steps_are_taken_as_they_are():
    _, force, *_ = samples(300)
    steps = np.resize([0.004, 0.012, 0.008], 299)
    run = moris.Washout().run(np.concatenate([[0], np.cumsum(steps)]), force)
    # The platform's velocity is the derivative of its position, whatever the steps.
    position, velocity = run["platform.position"], run["platform.velocity"]
    mean = 0.5 * (velocity[1:] + velocity[:-1])
    assert np.abs(np.diff(position, axis=0) / np.diff(run.time)[:, None] - mean).max() < 1e-2 * np.abs(velocity).max()


def test_outputs_have_the_fmus_names_shapes_and_kinds(ride):
    force = np.column_stack([ride["ax"], ride["ay"], ride["az"]])
    run = moris.Washout().run(ride["time"], force)
    count = len(ride["time"])
    assert list(run) == list(moris.variables("output"))
    assert run["actuator.length"].shape == (count, 6) and run["platform.orientation"].shape == (count, 3)
    assert np.array_equal(run["platform.orientation"][:, 1], run["platform.orientation.pitch"])
    assert run["status.tiltLimited"].dtype == bool and run["predictive.iterations"].dtype == int
    assert run["tilt.roll"].shape == (count,)
    frame = run.to_pandas()
    assert list(frame.columns) == list(run) and frame.index.name == "time" and len(frame) == count
    with pytest.raises(KeyError, match=r"did you mean .*actuator\[1\].length"):
        run["actuator[1].lenght"]


@pytest.mark.parametrize(
    ("arguments", "parameter", "message"),
    [
        ({"parameters": {"spliter.x.omega1": 2.0}}, "spliter.x.omega1", "did you mean splitter.x.omega1"),
        ({"parameters": {"tilt.rateLimit": -1.0}}, "tilt.rateLimit", "is -1, but must be from"),
        ({"parameters": {"tilt.rateLimit": float("nan")}}, "tilt.rateLimit", "must be a finite number"),
        ({"parameters": {"gravityRemoval": "ful"}}, "gravityRemoval", "must be one of head_vertical, full, none"),
        ({"parameters": {"head.torsoLength": 1.5}}, "head.torsoLength", "must not exceed head.height"),
        ({"parameters": "classicle"}, "classicle", "did you mean classical"),
        ({"strategy": "optimum"}, "strategy", "must be one of classical, adaptive, optimal, predictive"),
        ({"rig": {"neutralHight": 1.0}}, "neutralHight", "did you mean neutralHeight"),
        ({"rig": "no/such/rig.toml"}, None, "cannot read no/such/rig.toml"),
    ],
)
def test_an_error_names_the_parameter_and_the_remedy(arguments, parameter, message):
    with pytest.raises(moris.ParameterError) as caught:
        moris.Washout(**arguments)
    assert message in str(caught.value)
    assert caught.value.parameter == parameter
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.parameter) == (str(caught.value), parameter)


def test_the_error_of_a_combination_has_the_value():
    with pytest.raises(moris.ParameterError) as caught:
        moris.Washout(parameters={"head.torsoLength": 1.5})
    assert caught.value.value == 1.5


def test_parameters_come_from_presets_dicts_files_and_lists(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("[tilt]\nrateLimit = 0.03\n")
    washout = moris.Washout(parameters=["classical", file, {"tilt": {"angleLimit": np.float32(0.25)}, "limit.specificForce.x": np.int64(7)}])
    values = washout.parameters
    assert (values["tilt.rateLimit"], values["tilt.angleLimit"], values["limit.specificForce.x"]) == (0.03, 0.25, 7.0)
    assert values["strategy"] == "classical" and set(values) == set(moris.variables("parameter"))
    assert moris.Washout(parameters=values) == washout


def test_a_rig_comes_from_a_file_or_a_dict():
    from conftest import ROOT

    rig = ROOT / "examples" / "rigs" / "compact.toml"
    try:
        import tomllib
    except ImportError:
        pytest.skip("needs tomllib: run the tests with Python 3.11 or newer")
    assert moris.Washout(rig=rig) == moris.Washout(rig=tomllib.loads(rig.read_text()))
    assert moris.Washout(rig=str(rig)) != moris.Washout()


def test_retuning_in_motion_does_not_jump_and_keeps_fixed_parameters():
    t, force, rate, *_ = samples(600)
    washout = moris.Washout()
    before = washout.run(t[:301], force[:301], rate[:301])
    washout.retune({"splitter.x.omega1": 1.0, "scale.specificForce.y": 0.3})
    assert washout.parameters["splitter.x.omega1"] == 1.0
    assert washout["actuator.length"] == tuple(before["actuator.length"][-1])
    with pytest.raises(moris.ParameterError) as caught:
        washout.retune({"head.height": 1.0})
    assert caught.value.parameter == "head.height" and washout.parameters["head.height"] != 1.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time": [0.0]}, "time has 1 samples"),
        ({"time": [0.0, 0.02, 0.01]}, r"time\[2\] is 0.01 s after 0.02 s"),
        ({"specific_force": np.zeros((3, 4))}, r"specific_force has the shape \(3, 4\), but must have \(3, 3\)"),
        ({"specific_force": np.zeros((4, 3))}, r"shape \(4, 3\), but must have \(3, 3\)"),
        ({"angular_velocity": [["a"] * 3] * 3}, "angular_velocity is no array of numbers"),
        ({"speed": np.zeros((3, 1))}, r"speed has the shape \(3, 1\), but must have \(3,\)"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(change, message):
    arrays = {"time": [0.0, 0.01, 0.02], "specific_force": np.tile([0, 0, 9.81], (3, 1)), **change}
    washout = moris.Washout()
    with pytest.raises(moris.RecordingError, match=message):
        washout.run(**arrays)
    assert washout == moris.Washout()


def test_a_transposed_array_is_recognised():
    with pytest.raises(moris.RecordingError, match="transpose it"):
        moris.Washout().run(np.arange(100) * 0.01, np.zeros((3, 100)))


@pytest.mark.parametrize("dt", [0.0, -0.01, float("nan"), float("inf"), 1e9])
def test_a_step_of_no_length_is_refused(dt):
    with pytest.raises(ValueError, match="dt is"):
        moris.Washout().step(dt)


def test_any_input_is_safe():
    washout = moris.Washout()
    for force in ([float("nan")] * 3, (1e300, -1e300, float("inf")), [0, 0, 0]):
        for _ in range(200):
            lengths = washout.step(0.01, force, (1e9, float("nan"), 0.0), nan="rest")["actuator.length"]
            assert all(1.0 <= length <= 1.6 for length in lengths)
    for force in ((1.0, 2.0), "abc", ("a", "b", "c"), 1.0):
        with pytest.raises(TypeError, match="specific_force is .* three numbers"):
            washout.step(0.01, force)


def test_nan_is_an_error_that_names_the_sample_unless_it_is_rest():
    time = np.arange(200) * 0.01
    force = np.tile([1.0, 0.5, 9.80665], (200, 1))
    gap = force.copy()
    gap[120, 1] = np.nan
    washout = moris.Washout()
    before = washout.copy()
    with pytest.raises(moris.RecordingError, match=r"specific_force\[120, 1\] is NaN.*nan=\"rest\""):
        washout.run(time, gap)
    lean = np.where(np.arange(200) == 7, np.nan, 0.0)
    with pytest.raises(moris.RecordingError, match=r"lean\[7\] is NaN"):
        washout.run(time, force, lean=lean)
    for inputs, name in (
        ({"specific_force": (0.0, 0.0, np.nan)}, r"specific_force\[2\]"),
        ({"angular_velocity": (np.nan, 0.0, 0.0)}, r"angular_velocity\[0\]"),
        ({"orientation": (0.0, np.nan, 0.0)}, r"orientation\[1\]"),
        ({"speed": np.nan}, "speed"),
        ({"lean": np.nan}, "lean"),
    ):
        with pytest.raises(ValueError, match=f"^{name} is NaN"):
            washout.step(0.01, **inputs)
    with pytest.raises(ValueError, match="nan is \"skip\""):
        washout.step(0.01, nan="skip")
    assert washout == before, "nothing was stepped"
    at_rest = force.copy()
    at_rest[120, 1] = 0.0
    lengths = [moris.Washout().run(time, forces, nan="rest")["actuator.length"] for forces in (gap, at_rest)]
    assert np.array_equal(*lengths)


def test_other_threads_run_during_a_run():
    ride = gentle(300.0, 0.001)
    force = np.column_stack([ride["ax"], ride["ay"], ride["az"]])
    counted = 0
    done = threading.Event()

    def work():
        moris.Washout().run(ride["time"], force)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        counted += 1
        clock.sleep(0.001)
    thread.join()
    # With the lock held, this thread would get in before and after the loop only.
    assert counted > 10


def test_every_variable_is_described():
    for variable in moris.variables().values():
        assert variable.description and variable.min < variable.max or variable.kind == "boolean"
    with pytest.raises(ValueError, match="causality is 'inputs', but must be 'input', 'output' or 'parameter'"):
        moris.variables("inputs")
    assert moris.variables()["platform.position.x"].unit == "m"
    assert moris.variables()["platform.position.x"].vector == "platform.position"


def test_the_variables_are_those_of_the_fmu(fmu):
    described = {variable.name: variable for variable in read_model_description(str(fmu)).modelVariables}
    described.pop("time", None)
    rows = moris.variables()
    assert set(rows) == set(described)
    assert rows["vehicle.preview.step"].unit == "s" and rows["vehicle.preview.count"].max == 20
    for name, row in rows.items():
        assert row.causality == described[name].causality, name
        assert row.unit == (described[name].unit or ""), name


def test_what_is_shipped_goes_by_name():
    assert {"default", "classical", "paper"} <= set(moris.presets())
    assert {"default", "hobby150", "narrow"} <= set(moris.rigs())
    for name in moris.rigs():
        file = ROOT / "examples" / "rigs" / f"{name}.toml"
        assert moris.parameters(rig=name) == moris.parameters(rig=file), name
    for name in moris.presets():
        moris.Washout(parameters=name)
    with pytest.raises(moris.ParameterError, match="hoby150 is neither a file nor a rig .* hobby150"):
        moris.Washout(rig="hoby150")


def test_a_run_refuses_free_fall_as_a_simulation_does(ride):
    force = np.column_stack([ride["ax"], ride["ay"], ride["az"] - STANDARD_GRAVITY])
    with pytest.raises(moris.RecordingError, match="as in free fall.*gravityRemoval"):
        moris.Washout().run(ride["time"], force)
    without = moris.Washout(parameters={"gravityRemoval": "none"}).run(ride["time"], force)
    with_gravity = moris.Washout(parameters={"gravityRemoval": "head_vertical"}).run(ride["time"], force + [0, 0, STANDARD_GRAVITY])
    assert np.allclose(without["platform.position"], with_gravity["platform.position"], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("act", "doubt"),
    [
        (lambda: moris.Washout(parameters={"tilt.rateLimit": 3.0}), "in degrees it would be 0.0524 rad/s"),
        (lambda: moris.Washout().retune({"scale.specificForce.x": -5.0}), "scale.specificForce.x is -5, but the usual range"),
        (lambda: moris.Washout().step(0.001, (0.0, 0.0, 0.0)), "as in free fall"),
        (lambda: moris.Washout().run([0.0, 0.1], [(0.0, 0.0, 2 * STANDARD_GRAVITY)] * 2), "added twice"),
    ],
)
def test_a_doubtful_value_is_a_warning(act, doubt):
    with pytest.warns(UserWarning, match=re.escape(doubt)) as caught:
        act()
    assert len(caught) == 1 and caught[0].filename == __file__


def test_what_is_right_or_known_is_no_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        washout = moris.Washout()
        washout.step(0.001, (1.0, 0.0, STANDARD_GRAVITY), engaged=False)
        washout.step(0.001, (0.0, 0.0, 0.0))
        washout.retune({"scale.specificForce.x": 0.5})
