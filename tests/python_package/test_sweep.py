"""Sweeps: on threads, pools and Dask, to the bit, with workers that are killed and schedulers that are lost."""

import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import moris
import numpy as np
import pytest
from conftest import only_all_cases

pytest.importorskip("distributed", reason="needs distributed: pip install distributed")
from distributed import Client, LocalCluster  # noqa: E402


def parameter_sets(count=24):
    return [{"splitter.x.omega1": 1.0 + 0.1 * k, "scale.specificForce.y": 0.3 + 0.02 * k} for k in range(count)]


@pytest.fixture(scope="module")
def recordings(rides):
    return [moris.Recording(columns, name=name, fade_in=1.0) for name, columns in rides]


@pytest.fixture(scope="module")
def here(recordings):
    return moris.sweep(recordings, parameter_sets(), progress=False)


def cluster(workers):
    return LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0)


def values(sweep):
    return np.array([result.values for result in sweep.value])


def assert_same(found, expected):
    assert np.array_equal(values(found), values(expected), equal_nan=True)
    assert [result.index for result in found.value] == [result.index for result in expected.value]


def test_a_sweep_has_the_measures_of_single_simulations(here, recordings):
    assert here.complete and here.done == 24 and here.recordings == ["ride 0", "ride 1", "ride 2"]
    for result in here.value[::7]:
        for place, recording in enumerate(recordings):
            measures = moris.simulate(recording, parameters=result.parameters).measures
            for name in moris.MEASURES:
                expected = measures.get(name)
                assert np.array_equal(result[name][place], np.nan if expected is None else expected, equal_nan=True), name
    assert len({float(result["specific force x RMS error"][0]) for result in here.value}) > 20
    frame = here.to_pandas()
    assert len(frame) == 24 * 3 and frame.loc[3, "recording"] == "ride 0"
    with pytest.raises(KeyError, match="did you mean platform stroke used"):
        here.value[0]["platform stroke usd"]


def test_a_preview_is_an_error_of_the_sets_without_the_predictive_strategy(recordings):
    swept = moris.sweep(recordings[0], ["classical", "default"], preview=2.0)
    assert [result.error for result in swept.value] == [
        'preview is for the predictive strategy alone; add strategy="predictive"',
        None,
    ]


def test_a_sweep_previews_the_recordings(recordings):
    swept = moris.sweep(recordings[0], ["preview", "default"], preview=2.0)
    for result in swept.value:
        measures = moris.simulate(recordings[0], parameters=result.parameters, preview=2.0).measures
        assert result["specific force x RMS error"][0] == measures["specific force x RMS error"]
        assert measures["specific force x RMS error"] != moris.simulate(recordings[0], parameters=result.parameters).measures["specific force x RMS error"]


@pytest.mark.parametrize("chunk", [1, 5, 100])
def test_the_size_of_chunks_and_the_number_of_threads_change_nothing(here, recordings, chunk):
    assert_same(moris.sweep(recordings, parameter_sets(), chunk=chunk), here)


@pytest.mark.parametrize("workers", [pytest.param(1, marks=only_all_cases), 2, pytest.param(3, marks=only_all_cases)])
def test_workers_give_the_same_to_the_bit(here, recordings, workers):
    with cluster(workers) as made, Client(made) as client:
        assert_same(moris.sweep(recordings, parameter_sets(), executor=client.get_executor(), workers=workers, chunk=2), here)


def test_a_killed_worker_costs_time_and_nothing_else(here, recordings):
    with cluster(2) as made, Client(made) as client:
        killed = []

        def progress(done, total, text):
            if not killed:
                pid = next(iter(client.run(os.getpid).values()))
                os.kill(pid, signal.SIGKILL)
                killed.append((pid, done))

        found = moris.sweep(recordings, parameter_sets(), executor=client.get_executor(), chunk=1, progress=progress)
        assert killed and killed[0][1] < 24
        assert killed[0][0] not in client.run(os.getpid).values()
    assert found.complete
    assert_same(found, here)


def test_results_are_reduced_in_order_as_they_come(recordings):
    seen = []
    most = [0]
    drawn = [0]

    def sets():
        for parameters in parameter_sets(60):
            drawn[0] += 1
            yield parameters

    def reduce(total, result):
        seen.append(result.index)
        most[0] = max(most[0], drawn[0] - len(seen))
        return total + result["specific force x RMS error"].sum()

    with cluster(2) as made, Client(made) as client:
        found = moris.sweep(recordings[:1], sets(), reduce, initial=0.0, executor=client.get_executor(), workers=2, chunk=1)
    assert seen == list(range(60)) and found.done == 60
    # Only what is on its way has been drawn from the generator: memory does not grow with the number of sets.
    assert most[0] <= 4 * 2 + 1
    assert found.value == moris.sweep(recordings[:1], parameter_sets(60), reduce, initial=0.0).value


def test_the_best_are_kept(here, recordings):
    def cost(result):
        return result["specific force x RMS error"].mean()

    found = moris.sweep(recordings, parameter_sets(), moris.best(3, cost)).value
    expected = sorted(here.value, key=cost)[:3]
    assert [result.index for _, result in found] == [result.index for result in expected]
    assert [price for price, _ in found] == [cost(result) for result in expected]


def test_a_set_that_cannot_be_used_has_its_error_and_the_others_their_results(recordings):
    sets = [{"tilt.rateLimit": 0.03}, {"tilt.rateLimit": -1.0}, {"tilt.ratelimt": 1.0}, {"tilt.rateLimit": 0.04}]
    found = moris.sweep(recordings[:1], sets).value
    assert [result.error is None for result in found] == [True, False, False, True]
    assert "is -1, but must be from" in found[1].error and "did you mean tilt.rateLimit" in found[2].error
    assert np.isnan(found[1].values).all() and np.isfinite(found[3]["specific force x RMS error"]).all()
    assert [index for _, index in ((p, r.index) for p, r in moris.sweep(recordings[:1], sets, moris.best(9, lambda r: 1.0)).value)] == [0, 3]


@pytest.mark.parametrize("on_a_cluster", [False, True])
def test_what_is_cancelled_keeps_what_is_done(here, recordings, on_a_cluster):
    def swept(executor):
        cancel = threading.Event()

        def progress(done, total, text):
            if done >= 4:
                cancel.set()

        return moris.sweep(recordings, parameter_sets(), executor=executor, workers=1, chunk=2, progress=progress, cancel=cancel)

    if on_a_cluster:
        with cluster(1) as made, Client(made) as client:
            found = swept(client.get_executor())
            assert client.submit(sum, [1, 2]).result() == 3
    else:
        found = swept(None)
    assert not found.complete and 4 <= found.done < 24
    assert np.array_equal(values(found), values(here)[: found.done], equal_nan=True)


def test_ctrl_c_keeps_what_is_done(recordings):
    def progress(done, total, text):
        signal.raise_signal(signal.SIGINT)

    found = moris.sweep(recordings, parameter_sets(), chunk=1, progress=progress)
    assert not found.complete and 0 < found.done < 24


def test_a_lost_scheduler_is_a_clear_error_with_what_was_done(recordings):
    made = cluster(1)
    client = Client(made)
    try:

        def progress(done, total, text):
            if done >= 4:
                made.close()

        with pytest.raises(moris.ExecutorError, match="lost a task .*start it again") as caught:
            moris.sweep(recordings, parameter_sets(400), executor=client.get_executor(), chunk=2, progress=progress)
        assert 4 <= caught.value.partial.done < 400 and not caught.value.partial.complete
        with pytest.raises(moris.ExecutorError, match="lost a task"):
            moris.sweep(recordings, parameter_sets(), executor=client.get_executor())
    finally:
        client.close()
        made.close()


def test_a_pool_of_processes_gives_the_same_and_a_killed_one_is_a_clear_error(here, recordings):
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        assert_same(moris.sweep(recordings, parameter_sets(), executor=pool, chunk=3), here)

        def progress(done, total, text):
            if done >= 4:
                os.kill(next(iter(pool._processes)), signal.SIGKILL)

        with pytest.raises(moris.ExecutorError, match="lost a task .BrokenProcessPool") as caught:
            moris.sweep(recordings, parameter_sets(400), executor=pool, chunk=2, progress=progress)
        assert 4 <= caught.value.partial.done < 400


def test_no_executor_is_a_type_error(recordings):
    with pytest.raises(TypeError, match="executor must be a concurrent.futures.Executor, not str"):
        moris.sweep(recordings, parameter_sets(), executor="tcp://somewhere:8786")
    with pytest.raises(ValueError, match="recordings is empty"):
        moris.sweep([], parameter_sets())
    with pytest.raises(TypeError, match="parameter_sets is a single set; give several"):
        moris.sweep(recordings, {"tilt.rateLimit": 0.03})
    with pytest.raises(ValueError, match="chunk is -1"):
        moris.sweep(recordings, parameter_sets(), chunk=-1)


SETS = 12_000
"""Sets whose results would take much more memory than a process's own comes and goes."""


def short_recordings(count=11):
    """Recordings of three samples: a sweep over them costs little beside its results."""
    t = 0.01 * np.arange(3)
    still = {"az": 9.80665 + 0 * t, "wx": 0 * t, "wy": 0 * t, "wz": 0 * t}
    return [moris.Recording({"time": t, "ax": 0.1 * k + t, "ay": t, **still}, name=f"ride {k}") for k in range(count)]


def resident_memory():
    """Resident memory of this process [B]."""
    import psutil

    return psutil.Process().memory_info().rss


@only_all_cases
def test_memory_on_threads_is_that_of_the_results_kept():
    recordings = short_recordings()
    seen = {}

    def progress(done, total, text):
        seen[done] = resident_memory()

    def growth(reduce):
        seen.clear()
        sets = ({"splitter.x.omega1": 1.0 + 1e-5 * k} for k in range(SETS))
        assert moris.sweep(recordings, sets, reduce, progress=progress).done == SETS
        return seen[SETS] - next(memory for done, memory in seen.items() if done >= SETS / 2)

    results = SETS / 2 * len(recordings) * len(moris.MEASURES) * 8
    assert growth(lambda count, result: (count or 0) + 1) < 0.2 * results
    # What the limit would show: a sweep that keeps its results.
    assert growth(None) > 0.8 * results


@only_all_cases
def test_a_cluster_holds_no_more_than_the_tasks_on_their_way():
    recordings = short_recordings()
    tasks, data, memory = [], [], {}

    def held(dask_scheduler):
        return len(dask_scheduler.tasks)

    def stored(dask_worker):
        return len(dask_worker.data)

    with cluster(1) as made, Client(made) as client:

        def progress(done, total, text):
            if done % 1000 == 0:
                tasks.append(client.run_on_scheduler(held))
                data.extend(client.run(stored).values())
                memory[done] = next(iter(client.run(resident_memory).values()))

        sets = ({"splitter.x.omega1": 1.0 + 1e-5 * k} for k in range(SETS))
        executor = client.get_executor()
        count = moris.sweep(recordings, sets, lambda count, result: count + 1, initial=0, executor=executor, workers=1, chunk=100, progress=progress)
    assert count.value == SETS and len(tasks) == SETS // 1000
    # Beside those on their way are the context, the task just done, and one that is being forgotten.
    assert max(tasks) <= 4 + 3 and max(data) <= 4 + 3
    results = SETS / 2 * len(recordings) * len(moris.MEASURES) * 8
    assert memory[SETS] - memory[SETS // 2] < 0.3 * results
