"""Tuning: the workbench's result, early stops, and the same on Dask."""

import os
import re
import signal
import subprocess

import moris
import numpy as np
import pandas
import pytest
from conftest import ROOT, only_all_cases


@pytest.fixture(scope="module")
def recordings(rides):
    return [moris.Recording(columns, name=name.replace(" ", "-"), fade_in=1.0) for name, columns in rides]


@pytest.fixture(scope="module")
def tuned(recordings):
    return moris.tune(recordings, strategy="classical", folds=0, evaluations=150, progress=False)


def test_tuning_lowers_the_error_and_keeps_the_limits(tuned, recordings):
    assert not tuned.interrupted and set(tuned.errors) == {"ride-0", "ride-1", "ride-2"}
    assert sum(one["tuned"] for one in tuned.errors.values()) < sum(one["before"] for one in tuned.errors.values())
    for recording in recordings:
        simulation = moris.simulate(recording, parameters=tuned.parameters)
        assert simulation.fits and simulation["status.strokeMargin"].min() >= 0.01
    groups = ("splitter.", "angular.", "scale.")
    assert tuned.changed and all(name.startswith(groups) for name in tuned.changed)
    assert tuned.verdict.startswith("No recording was held out") and tuned.verdict in tuned.summary
    assert list(tuned.to_pandas().columns) == ["before", "tuned", "unseen"]


def test_each_strategy_is_tuned_and_the_best_is_the_result(recordings):
    best = moris.tune(recordings[0], strategy="all", groups=["scale"], evaluations=10, progress=False)
    assert set(best.strategies) == {"classical", "adaptive", "optimal", "predictive", "robust"}
    assert best.error == min(tuned.error for tuned in best.strategies.values())
    assert best.parameters == best.strategies[best.parameters["strategy"]].parameters


def test_the_objective_is_the_shape_or_the_sensed_error(recordings):
    by_shape, by_error = (
        moris.tune(recordings[0], strategy="classical", groups=["scale"], evaluations=40, objective=objective)
        for objective in ("shape", "error")
    )
    assert by_shape.parameters != by_error.parameters
    assert by_shape.errors["ride-0"]["before"] != by_error.errors["ride-0"]["before"]


def test_the_parameter_file_is_the_result(tuned, tmp_path):
    assert moris.parameters(parameters=tuned.save(tmp_path / "tuned.toml")) == tuned.parameters


def test_the_command_finds_the_same(tuned, rides, tmp_path):
    for name, columns in rides:
        pandas.DataFrame(columns).to_csv(tmp_path / f"{name.replace(' ', '-')}.csv", index=False)
    files = [str(tmp_path / f"ride-{k}.csv") for k in range(3)]
    command = ["cargo", "moris", "tune", *files, "--strategy", "classical", "--folds", "0", "--evaluations", "150"]
    command += ["--output", str(tmp_path / "tuned.toml"), "--report", str(tmp_path / "report")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert moris.parameters(parameters=tmp_path / "tuned.toml") == tuned.parameters


@only_all_cases
def test_workers_find_the_same_to_the_bit_though_one_is_killed(tuned, recordings):
    pytest.importorskip("distributed", reason="needs distributed: pip install distributed")
    from distributed import Client, LocalCluster

    cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0)
    with cluster, Client(cluster) as client:
        killed = []

        def progress(done, total, text):
            if not killed and done > 20:
                killed.append(next(iter(client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)

        found = moris.tune(recordings, strategy="classical", folds=0, evaluations=150, executor=client.get_executor(), progress=progress)
    assert killed
    assert found.parameters == tuned.parameters and found.errors == tuned.errors


def test_left_out_recordings_are_tried(recordings):
    found = moris.tune(recordings[:2], strategy="classical", hold_out=recordings[2], groups=["scale"], evaluations=40)
    assert found.errors["ride-2"]["tuned"] is None and found.errors["ride-2"]["unseen"] > 0
    assert all(name.startswith("scale.") for name in found.changed)


def test_a_search_ends_early_and_keeps_the_best(recordings):
    calls = []

    def progress(done, total, text):
        calls.append((done, total, text))

    def stop(search, tried, error):
        return tried > 60

    found = moris.tune(recordings[:1], strategy="classical", evaluations=5000, stop=stop, progress=progress)
    assert found.interrupted and found.changed and "was interrupted" in found.summary
    assert calls[-1][0] < 5000 and calls[-1][1] == 5000 and "error 0." in calls[-1][2]
    patient = moris.tune(recordings[:1], strategy="classical", groups=["scale"], evaluations=5000, patience=30, progress=progress)
    assert not patient.interrupted and calls[-1][0] < 4000

    def interrupt(done, total, text):
        signal.raise_signal(signal.SIGINT)

    # Every call is another Ctrl-C: none of them loses the result.
    interrupted = moris.tune(recordings[:1], strategy="classical", evaluations=5000, progress=interrupt)
    assert interrupted.interrupted and interrupted.errors["ride-0"]["tuned"] <= interrupted.errors["ride-0"]["before"]


def test_an_error_of_the_callers_function_ends_the_search(recordings):
    def stop(search, tried, error):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        moris.tune(recordings[:1], strategy="classical", evaluations=5000, stop=stop)


def test_every_group_has_parameters_and_is_in_the_documentation():
    variables = moris.variables("parameter").values()
    groups = {variable.group for variable in variables if variable.group}
    (named,) = re.findall(r"parameters that may change: ([^.]*)\.", moris.tune.__doc__)
    assert set(re.findall(r'"(\w+)"', named)) == groups
    assert moris.variables()["tilt.rateLimit"].usual == (0.02, 0.053)
    assert all(each.min <= each.usual[0] < each.usual[1] <= each.max for each in variables if each.usual)


def test_limits_that_no_parameters_keep_are_told(recordings):
    rig = {
        "name": "tiny",
        "neutralHeight": 1.091,
        "base": {"radius": 1.0, "degrees": [-8, 8, 112, 128, 232, 248]},
        "platform": {"radius": 0.85, "degrees": [-52, 52, 68, 172, 188, 292]},
        "actuator": {"minLength": 1.0, "maxLength": 1.6, "velocityLimit": 1.0, "accelerationLimit": 15.0},
    }
    with pytest.raises(moris.NoFeasibleParameters, match="no parameters were found with which every recording stays clear"):
        moris.tune(recordings[:1], strategy="classical", rig=rig, stroke_reserve=0.29, groups=["angular"], evaluations=20)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"groups": ["splitters"]}, "there is no group splitters; there are splitter, angular, scale, cutoff, tilt, strategy, order"),
        ({"weights": [0, 0, 0, 0, 0, 0]}, "must be six numbers, none below 0 and not all 0"),
        ({"stroke_reserve": -0.1}, "stroke_reserve is -0.1 m"),
        ({"comfort": [0.2, 0, 4]}, "must be bounds of shake, jolt and peak above 0 m/s2"),
        ({"objective": "size"}, "objective is size, but must be shape or error"),
        ({"evaluations": 0}, "evaluations is 0, but must be 1 at least"),
        ({"patience": 0}, "patience is 0, but must be 1 at least"),
        ({"folds": -1}, "folds is -1, but must be 0 at least"),
        ({"seed": -1}, "seed is -1, but must be 0 at least"),
        ({"hold_out": "itself"}, "two recordings are called ride-0"),
    ],
)
def test_arguments_that_cannot_be_are_refused(recordings, arguments, message):
    if "hold_out" in arguments:
        arguments = {"hold_out": recordings[0]}
    with pytest.raises(ValueError, match=message):
        moris.tune(recordings[0], strategy="classical", **arguments)


def test_a_result_is_the_same_for_the_same_seed(recordings):
    once, again = (moris.tune(recordings[:1], strategy="classical", groups=["scale"], evaluations=60, seed=3) for _ in range(2))
    assert once.parameters == again.parameters
    other = moris.tune(recordings[:1], strategy="classical", groups=["scale"], evaluations=60, seed=4)
    assert other.parameters != once.parameters
    assert np.isfinite([value["tuned"] for value in other.errors.values()]).all()
