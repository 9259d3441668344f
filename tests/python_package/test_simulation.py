"""Simulations, bounds, frequency responses and surveys."""

import pickle
import subprocess
import sys
from typing import get_args

import moris
import numpy as np
import pytest
from conftest import ROOT, STANDARD_GRAVITY, only_all_cases
from moris import _types


@pytest.fixture
def simulation(ride):
    return moris.simulate(ride)


def test_a_simulation_is_a_run_of_the_washout(ride):
    simulation = moris.simulate(ride, fade_in=0.0)
    force = np.column_stack([ride["ax"], ride["ay"], ride["az"]])
    rate = np.column_stack([ride["wx"], ride["wy"], ride["wz"]])
    run = moris.Washout(parameters={"angularVelocityFrame": "body"}).run(ride["time"], force, rate)
    for name in run:
        assert np.array_equal(simulation[name], run[name]), name
    assert np.array_equal(simulation["vehicle.specificForce"], force)


def test_a_comparison_has_every_strategy_and_other_washouts_of_each_recording(ride):
    def at_rest(recording):
        neutral = [0.0, 0.0, moris.parameters()["rig.neutralHeight"], 0.0, 0.0, 0.0]
        return moris.measure(recording, pose=np.tile(neutral, (round(recording.duration / recording.step) + 1, 1)))

    slower = ride | {"ax": 0.5 * ride["ax"]}
    compared = moris.compare([ride, slower], {"at rest": at_rest})
    names = [*get_args(_types.Strategy), "at rest"]
    assert [one.name for one in compared] == names * 2
    table = compared.to_pandas()
    assert list(table.index.get_level_values("washout")) == names * 2
    robust = moris.simulate(ride, strategy="robust")
    assert table["specific force x RMS error"].iloc[4] == robust.measures["specific force x RMS error"]
    assert compared[5].measures["specific force x RMS error"] > 1.01 * robust.measures["specific force x RMS error"]
    figure = compared.plot()
    assert [len(axis.lines) for axis in figure.axes] == [len(names) + 1] * 4
    header, *lines = str(compared).splitlines()
    assert header.split()[:5] == ["recording", "washout", "surge", "shape", "surge"] and len(lines) == len(compared)
    assert f"{robust.measures['specific force x RMS error']:.3g}" in lines[4] and "at rest" in lines[5]
    assert len(moris.compare(ride, strategies=["optimal"])) == 1
    with pytest.raises(ValueError, match="'robust', which is the name of a strategy"):
        moris.compare(ride, {"robust": at_rest})


def test_a_preview_is_the_recordings_own_future(ride):
    """Means over a triangle around each element, as docs/strategies/predictive.md says."""
    force = np.column_stack([ride["ax"], ride["ay"], ride["az"]])
    rate = np.column_stack([ride["wx"], ride["wy"], ride["wz"]])
    count, apart, elements = len(force), 20, 5
    weights = np.bartlett(2 * apart + 1)[1:-1]
    mean = np.column_stack([np.convolve(force[:, k], weights / weights.sum(), mode="same") for k in range(2)])
    ahead = np.arange(count)[:, None] + apart * np.arange(1, elements + 1)
    previews = np.where((ahead < count)[:, :, None], mean[np.minimum(ahead, count - 1)], np.nan)
    parameters = ["preview", {"angularVelocityFrame": "body"}]
    expected = moris.Washout(parameters=parameters).run(ride["time"], force, rate, preview=previews)
    found = moris.simulate(ride, parameters="preview", preview=1.0, fade_in=0.0)
    # The triangle is cut off at the recording's end.
    until = count - (elements + 1) * apart
    assert np.allclose(found["platform.position"][:until], expected["platform.position"][:until], rtol=0, atol=1e-9)
    assert found.preview == 1.0 and found.name.endswith("preview of 1 s")
    without = moris.simulate(ride, parameters="preview")
    names = [f"specific force {axis} RMS error" for axis in "xy"]
    assert sum(found.measures[name] for name in names) < 0.7 * sum(without.measures[name] for name in names)
    for seconds in (-0.1, 4.1, float("nan")):
        with pytest.raises(ValueError, match="preview is .* s, but must be from 0 to 4 s"):
            moris.simulate(ride, preview=seconds)


def test_measures_are_those_of_the_series(simulation):
    desired, felt = simulation["vehicle.specificForce"], simulation["rider.specificForce"]
    for k, axis in enumerate("xyz"):
        error = felt[:, k] - desired[:, k]
        assert simulation.measures[f"specific force {axis} RMS error"] == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-12)
        assert simulation.measures[f"specific force {axis} peak error"] == pytest.approx(np.abs(error).max(), rel=1e-12)
        correlation = np.corrcoef(desired[:, k], felt[:, k])[0, 1]
        assert simulation.measures[f"specific force {axis} correlation"] == pytest.approx(correlation, rel=1e-9)
    margin = simulation["status.strokeMargin"].min()
    assert simulation.measures["platform smallest stroke margin"] == pytest.approx(margin, rel=1e-12)
    frame = simulation.measures.to_pandas()
    assert len(frame) == len(simulation.measures) and frame["definition"].str.len().min() > 10
    with pytest.raises(KeyError, match="did you mean specific force x RMS error"):
        simulation.measures["specific force x RMS eror"]


def test_a_frame_has_every_input_and_output(simulation):
    frame = simulation.to_pandas()
    assert frame.shape == (len(simulation.time), len(simulation))
    assert np.array_equal(frame["actuator[3].length"], simulation["actuator.length"][:, 2])
    assert {"vehicle.speed", "status.safetyActive"} < set(frame.columns)


def test_a_report_is_a_page_that_compares(simulation, ride, tmp_path):
    other = moris.simulate(ride, parameters="paper")
    page = simulation.report(tmp_path / "new" / "ride.html", compare=[other])
    text = page.read_text(encoding="utf-8")
    assert text.startswith("<!doctype html>") and "paper" in text
    with pytest.raises(ValueError, match="name it with .html"):
        simulation.report(tmp_path / "ride.pdf")


def test_a_notebook_shows_findings_picture_and_measures(simulation, tmp_path):
    import matplotlib

    matplotlib.use("Agg")
    page = simulation._repr_html_()
    assert "data:image/png;base64," in page and "RMS error" in page and simulation.findings[0][:20] in page
    figure = simulation.plot()
    lines = figure.axes[0].get_lines()
    assert np.array_equal(lines[1].get_ydata(), simulation["rider.specificForce.x"])
    figure.savefig(tmp_path / "plot.png")


def test_the_bound_is_below_the_error_and_above_nothing(ride):
    found = moris.bound(ride)
    simulation = moris.simulate(ride, bound=True)
    assert set(found) <= {"surge", "sway", "heave"} and "surge" in found
    for axis, name in zip("xyz", ("surge", "sway", "heave")):
        if name not in found:
            continue
        bound = found[name]
        rest = STANDARD_GRAVITY if axis == "z" else 0.0
        desired = simulation[f"vehicle.specificForce.{axis}"] - rest
        assert bound.desired_rms == pytest.approx(np.sqrt(np.mean(desired**2)), rel=1e-12)
        assert bound.rms_error <= simulation.measures[f"specific force {axis} RMS error"] + 1e-9
        # The best trajectory attains the bound, but for the solver's tolerance and the samples between its intervals.
        attained = np.sqrt(np.mean((bound.felt - desired) ** 2))
        assert bound.rms_error <= attained + 1e-4 and attained < bound.rms_error + 0.05
        assert any("bound" in row.name for row in simulation.measures.rows)
    with pytest.raises(moris.BoundError, match="cannot compute the bound"):
        moris.bound({name: values[:2] for name, values in ride.items()})


@only_all_cases
def test_the_response_to_small_signals_is_the_filters_own():
    """Nothing but the angular channel's high-pass acts on yaw, times its scale; its order says which poles it has."""
    values = {"angular.yaw.omega1": 0.7, "angular.yaw.zeta1": 0.8, "angular.yaw.omega2": 0.4, "angular.yaw.zeta2": 1.1}
    values.update({"scale.angularVelocity.z": 0.5, "input.rateCutoff": 0.0})
    response = moris.frequency_response(parameters=values)
    s = 1j * response.frequencies
    order = moris.parameters()["angular.order"]
    first = s**2 / (s**2 + 2 * 0.8 * 0.7 * s + 0.7**2)
    second = {4: s**2 / (s**2 + 2 * 1.1 * 0.4 * s + 0.4**2), 3: s / (s + 0.4), 2: 1.0}[order]
    yaw = response.channels.index("yaw rate")
    found = response.small[yaw, :, yaw]
    assert np.allclose(found, 0.5 * first * second, rtol=0, atol=2e-3)
    assert response.settled[yaw].all() and (response.limited[yaw] == 0).all()
    frame = response.to_pandas()
    assert len(frame) == 6 * 12 * 6
    assert np.allclose(frame["modulus"], np.abs(response.ratios).ravel(), rtol=1e-14, atol=0)
    assert response.plot() is not None
    with pytest.raises(ValueError, match="force is 0"):
        moris.frequency_response(force=0.0)


def test_a_survey_reaches_as_far_as_the_legs():
    survey = moris.survey(samples=20_000)
    values = moris.parameters()
    base, platform = (
        np.array([[values[f"rig.{part}[{leg}].{axis}"] for axis in "xyz"] for leg in range(1, 7)]) for part in ("base", "platform")
    )
    # Straight up, a leg whose joints are d apart in plan has the length sqrt(d^2 + z^2).
    apart = np.linalg.norm((platform - base)[:, :2], axis=1)
    highest = np.sqrt(values["actuator.maxLength"] ** 2 - apart**2).min() - values["rig.neutralHeight"]
    assert survey.reach["heave"].max == pytest.approx(highest, abs=1e-6)
    assert survey.singular_at is None and survey.worst_condition < 4
    assert survey.closest_legs == (1, 6) and 0.2 < survey.leg_clearance < 0.24
    assert 0 < survey.tilted_volume < survey.volume < 2
    assert survey._repr_svg_().startswith("<svg") and "smallest singular value" in str(survey)


def test_a_singular_rig_is_surveyed_and_refused():
    circle = [0, 60, 120, 180, 240, 300]
    rig = {
        "name": "hexagons",
        "neutralHeight": 1.2,
        "base": {"radius": 1.0, "degrees": circle},
        "platform": {"radius": 1.0, "degrees": circle},
        "actuator": {"minLength": 1.0, "maxLength": 1.6, "velocityLimit": 1.0, "accelerationLimit": 15.0},
    }
    survey = moris.survey(rig, samples=1000)
    assert len(survey.singular_at) == 6 and survey.worst_condition is None
    with pytest.raises(moris.ParameterError, match="singular inside the stroke"):
        moris.Washout(rig=rig)


def test_parameters_are_written_as_the_workbench_reads_them(tmp_path):
    file = moris.write_parameters(tmp_path / "mine.toml", ["classical", {"tilt.rateLimit": 0.031, "compensation": "gravity"}])
    assert moris.parameters(parameters=file) == moris.parameters(
        parameters=["classical", {"tilt.rateLimit": 0.031, "compensation": "gravity"}]
    )


def test_a_built_fmu_has_the_parameters_as_start_values(tmp_path):
    from fmpy import read_model_description

    file = moris.build_fmu(parameters=["classical", {"tilt.rateLimit": 0.031}], output=tmp_path, source=ROOT)
    start = {variable.name: variable.start for variable in read_model_description(str(file)).modelVariables}
    values = moris.parameters(parameters=["classical", {"tilt.rateLimit": 0.031}])
    assert float(start["tilt.rateLimit"]) == 0.031
    assert float(start["splitter.x.omega1"]) == values["splitter.x.omega1"]


def test_an_fmu_from_a_base_is_the_built_one_to_the_byte(tmp_path, fmu):
    values = {"parameters": ["classical", {"tilt.rateLimit": 0.031}]}
    own = moris.build_fmu(**values, output=tmp_path / "Büro — 1 %20", base=fmu)
    built = moris.build_fmu(**values, output=tmp_path, source=ROOT)
    assert own.name == fmu.name and own.read_bytes() == built.read_bytes() != fmu.read_bytes()
    with pytest.raises(moris.BuildError, match="is the base"):
        moris.build_fmu(**values, output=own.parent, base=own)
    with pytest.raises(moris.BuildError, match="cannot be unpacked"):
        moris.build_fmu(**values, output=tmp_path, base=__file__)
    with pytest.raises(ValueError, match="those of the base"):
        moris.build_fmu(**values, output=tmp_path, base=fmu, fmi=3)


def test_a_build_without_sources_or_toolchain_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(moris.BuildError, match="give their directory as source="):
        moris.build_fmu()
    monkeypatch.setenv("PATH", "")
    with pytest.raises(moris.BuildError, match="https://rustup.rs"):
        moris.build_fmu(source=ROOT)


def test_the_package_keeps_to_its_types():
    config = ROOT / "tests" / "python_package" / "mypy.ini"
    for checked in (["mypy", "--config-file", config, "-p", "moris"], ["mypy.stubtest", "--mypy-config-file", config, "moris._moris"]):
        done = subprocess.run([sys.executable, "-m", *checked], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr


def test_the_strategies_of_the_types_are_those_of_the_washout():
    assert get_args(_types.Strategy) == moris.variables()["strategy"].items


def test_the_version_is_that_of_the_package():
    manifest = (ROOT / "Cargo.toml").read_text()
    assert f'version = "{moris.__version__}"' in manifest


def test_a_simulation_is_pickled_with_everything(ride):
    simulation = moris.simulate(ride, parameters="preview", preview=1.0, bound=True)
    again = pickle.loads(pickle.dumps(simulation))
    for name in simulation:
        assert np.array_equal(again[name], simulation[name]), name
    assert again.measures == simulation.measures and again.findings == simulation.findings
    assert (again.name, again.preview, again.parameters) == (simulation.name, simulation.preview, simulation.parameters)
    with pytest.raises(ValueError, match="damaged"):
        type(simulation._native)._from_state(simulation.recording._native, b"nothing")


def test_a_preview_without_the_predictive_strategy_is_an_error(ride):
    with pytest.raises(ValueError, match='preview is for the predictive strategy alone; add strategy="predictive"'):
        moris.simulate(ride, strategy="classical", preview=1.0)


def test_a_washout_is_shown_in_pythons_words():
    assert repr(moris.Washout()) == "Washout(strategy='predictive', started=False)"


def test_a_misspelt_option_is_found_before_it_runs(tmp_path):
    source = tmp_path / "ride.py"
    source.write_text('import moris\nmoris.simulate("ride.csv", force_unit="g")\nmoris.simulate("ride.csv", force_units="g")\n')
    config = ROOT / "tests" / "python_package" / "mypy.ini"
    done = subprocess.run([sys.executable, "-m", "mypy", "--config-file", config, source], capture_output=True, text=True)
    errors = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert len(errors) == 1 and ":3: " in errors[0] and "force_units" in errors[0], done.stdout + done.stderr


def rounds(count):
    """Rounds of 30 s with forces that belong to their places."""
    time = np.arange(0, count * 30, 0.02)
    angle = 2 * np.pi * time / 30
    zero = 0 * time
    columns = {"time": time, "ax": 1.5 * np.tanh(4 * np.sin(3 * angle)), "ay": 1.5 * np.tanh(4 * np.cos(4 * angle))}
    columns |= {"az": zero + 9.80665, "wx": zero, "wy": zero, "wz": zero}
    return columns | {"x": 80 * np.cos(angle), "y": 80 * np.sin(angle)}


def test_a_preview_is_learned_from_earlier_rounds():
    ride = rounds(2)
    plain = moris.simulate(ride, parameters="preview")
    learned = moris.simulate(ride, parameters="preview", learn=True)
    assert learned.learned and learned.name.endswith(", learned preview")
    second = learned.time > 40
    errors = [np.std((s["rider.specificForce"] - s.desired[0])[second], axis=0) for s in (learned, plain)]
    assert np.all(errors[0][:2] < 0.9 * errors[1][:2]), errors
    recording = pickle.loads(pickle.dumps(moris.Recording(ride, position=True)))
    again = moris.simulate(recording, parameters="preview", learn=True)
    assert np.array_equal(again["rider.specificForce"], learned["rider.specificForce"])
    with pytest.raises(ValueError, match="position=True"):
        moris.simulate(moris.Recording(ride), parameters="preview", learn=True)
    with pytest.raises(ValueError, match="exclude each other"):
        moris.simulate(ride, parameters="preview", preview=1.0, learn=True)
    with pytest.raises(ValueError, match="predictive strategy alone"):
        moris.simulate(ride, strategy="classical", learn=True)


def test_a_learned_road_is_kept_in_a_file(tmp_path):
    road = tmp_path / "track.laps"
    ride = rounds(1)
    ride["longitude"], ride["latitude"] = ride.pop("x") / 78847, 45 + ride.pop("y") / 111132
    first = moris.simulate(ride, parameters="preview", learn=str(road))
    assert road.read_text().startswith("moris-laps,1")
    second = moris.simulate(ride, parameters="preview", learn=road)
    assert second.learned
    late = first.time > 10
    errors = [np.std((s["rider.specificForce"] - s.desired[0])[late], axis=0) for s in (second, first)]
    assert np.all(errors[0][:2] < 0.95 * errors[1][:2]), errors
    road.write_text("x,y")
    with pytest.raises(ValueError, match="none of a road"):
        moris.simulate(ride, parameters="preview", learn=road)


def test_the_advice_of_a_verdict_is_a_set_of_parameters_that_is_better():
    time = np.arange(3001) * 0.01
    still = np.zeros_like(time)
    forces = {"ax": still, "ay": 4.0 * np.clip(time / 2, 0, 1) * np.sin(1.6 * time), "az": STANDARD_GRAVITY + still}
    slalom = moris.Recording({"time": time, **forces, "wx": still, "wy": still, "wz": still}, name="slalom")
    before = moris.simulate(slalom)
    assert before.verdict.startswith("Felt the wrong way round for ") and "Scale force and rates by 0." in before.verdict
    assert pickle.loads(pickle.dumps(before)).verdict == before.verdict
    after = moris.simulate(slalom, parameters=before.advice)
    assert after.verdict.startswith("Felt the right way round, at ") and after.advice is None
