"""Sweeps: many parameter sets on many recordings, reduced as they come."""

from __future__ import annotations

import itertools
import os
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sized
from concurrent.futures import Executor
from dataclasses import dataclass
from threading import Event
from typing import TYPE_CHECKING, Any, List, NamedTuple, Tuple, Union

import numpy as np

from . import _moris
from ._errors import ExecutorError
from ._executor import Workers
from ._optional import pandas
from ._progress import Progress
from ._recording import Recording, recordings_of
from ._types import Floats, ParameterSet, RecordingOptions, Rig, Show, Sources, Strategy
from ._variables import near_misses

if TYPE_CHECKING:
    from typing_extensions import Unpack

MEASURES: dict[str, str] = {f"{subject} {name}": unit for subject, name, unit in _moris.sweep_measures()}
"""The measures of a sweep by name, each with its unit."""

_COLUMNS = {name: column for column, name in enumerate(MEASURES)}

# The measures of each set of a chunk, and errors; chunks with theirs.
Measured = Tuple[Any, List[Union[str, None]]]
Run = Generator[Tuple[List[ParameterSet], Measured], None, None]

AHEAD = 4
"""Chunks on their way for each worker."""


@dataclass(eq=False, repr=False)
class Result:
    """The measures of one parameter set on all recordings.

    index: place of the set, from 0. parameters: the set as it was given. error: None, or why it cannot be used.
    result["specific force x RMS error"]: the measure of each recording, (R,), NaN where it is not defined.
    values: all measures, (R, number of MEASURES).
    """

    __slots__ = ("error", "index", "parameters", "values")

    index: int
    parameters: Any
    values: Floats
    error: str | None

    def __getitem__(self, name: str) -> Floats:
        if name not in _COLUMNS:
            raise KeyError(f"there is no measure {name}; {near_misses(name, _COLUMNS)}")
        return self.values[:, _COLUMNS[name]]

    def __repr__(self) -> str:
        return f"Result({self.index}, {self.parameters!r}{'' if self.error is None else f', error={self.error!r}'})"


@dataclass(eq=False, repr=False)
class Sweep:
    """Result of a sweep.

    value: of the reduction; without one, the list of Results. done: parameter sets in it. complete: False if it was ended
    before. recordings: the recordings' names.
    """

    value: Any
    done: int
    complete: bool
    recordings: list[str]

    def to_pandas(self) -> Any:
        """The measures as a pandas.DataFrame, a row for each set and recording: for sweeps without a reduction."""
        frames = []
        for result in self.value:
            frame = pandas().DataFrame(result.values, columns=list(MEASURES))
            frame.insert(0, "recording", self.recordings)
            frame.insert(0, "set", result.index)
            frames.append(frame)
        return pandas().concat(frames, ignore_index=True)

    def __repr__(self) -> str:
        return f"Sweep({self.done} parameter sets{'' if self.complete else ', ended before it was complete'})"


def best(count: int, cost: Callable[[Result], float]) -> Callable[[Any, Result], list[tuple[float, Result]]]:
    """A reduction to the `count` results of the least cost.

    cost: function of a Result to a number; NaN and results with an error are left out.
    """

    def reduce(kept: Any, result: Result) -> list[tuple[float, Result]]:
        value = float("nan") if result.error else float(cost(result))
        if np.isnan(value):
            return kept or []
        kept = [*(kept or []), (value, result)]
        kept.sort(key=lambda pair: (pair[0], pair[1].index))
        return kept[:count]

    return reduce


def sweep(
    recordings: Sources,
    parameter_sets: Iterable[ParameterSet],
    reduce: Callable[[Any, Result], Any] | None = None,
    *,
    initial: Any = None,
    rig: Rig | None = None,
    base: ParameterSet | None = None,
    strategy: Strategy | None = None,
    preview: float = 0.0,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int | None = None,
    progress: Show = None,
    cancel: Event | None = None,
    **options: Unpack[RecordingOptions],
) -> Sweep:
    """Simulates every recording with every parameter set, and reduces the measures as they come.

    recordings: one or several, each a Recording or what one is made of. parameter_sets: any iterable of sets, each as for
        Washout; it is read as far as needed, so that a generator of 1e5 sets takes no memory.
    reduce: reduce(accumulated, result) -> accumulated, called with each Result in the order of the sets, first with
        `initial`; None collects the Results in a list. moris.best(10, cost) keeps the best.
    rig, base, strategy: what every set is laid over. preview: as for simulate [s]; a set without the predictive strategy then
        has an error.
    executor: a concurrent.futures.Executor, whose workers then simulate; without it, the cores of this machine do. The
        results are the same to the bit. workers: number of its workers; by default that of this machine's cores.
    chunk: sets in a task; by default chosen by the recordings' length.
    progress: as for Progress: True, False, None or a function of (done, total, text).
    cancel: a threading.Event. Setting it, and Ctrl-C, end the sweep and keep what is done.

    Returns a Sweep. A set that cannot be used has a Result with an error. Raises ExecutorError where the executor loses a
    task; its `partial` is the Sweep until then.
    """
    if isinstance(parameter_sets, (str, Mapping)):
        raise TypeError("parameter_sets is a single set; give several, such as a list with it")
    if chunk is not None and chunk < 1:
        raise ValueError(f"chunk is {chunk}, but must be 1 at least")
    recordings = recordings_of(recordings, options)
    if not recordings:
        raise ValueError("recordings is empty; give one at least")
    total = len(parameter_sets) if isinstance(parameter_sets, Sized) else None
    chunk = chunk or _chunk(recordings)
    context = _Context([recording._native for recording in recordings], rig, base, strategy, preview)
    cancelled = cancel.is_set if cancel is not None else lambda: False
    bar = Progress(progress, total, "sweep", "set")
    made = Sweep(initial if reduce else [], 0, False, [recording.name for recording in recordings])
    if executor is None:
        # All cores of this machine share a chunk; a worker has one of its own.
        run = _here(context, _chunks(parameter_sets, chunk * (os.cpu_count() or 1)), cancelled)
    else:
        run = _elsewhere(Workers(executor, workers, _Context, context), _chunks(parameter_sets, chunk), cancelled)
    try:
        for sets, (values, errors) in run:
            for parameters, measures, error in zip(sets, values, errors):
                result = Result(made.done, parameters, measures, error)
                if reduce:
                    made.value = reduce(made.value, result)
                else:
                    made.value.append(result)
                made.done += 1
            bar.to(made.done, "sweep")
        made.complete = not cancelled()
    except KeyboardInterrupt:
        pass
    except ExecutorError as error:
        error.partial = made
        raise
    finally:
        run.close()
        bar.close()
    return made


class _Context(NamedTuple):
    """Data of every task; pickled once for each worker."""

    recordings: list[_moris.Recording]
    rig: Rig | None
    base: ParameterSet | None
    strategy: Strategy | None
    preview: float

    def measures(self, sets: list[ParameterSet], threads: int) -> Measured:
        laid_over = [[part for part in (self.base, parameters) if part is not None] for parameters in sets]
        return _moris.sweep_chunk(self.recordings, self.rig, laid_over, self.strategy, self.preview, threads)


def _chunk(recordings: list[Recording]) -> int:
    """As many sets as take some tenths of a second on a core."""
    samples = sum(recording.duration / recording.step for recording in recordings)
    return max(1, min(256, round(1e5 / samples)))


def _chunks(parameter_sets: Iterable[ParameterSet], size: int) -> Iterator[list[ParameterSet]]:
    sets = iter(parameter_sets)
    while part := list(itertools.islice(sets, size)):
        yield part


def _here(context: _Context, chunks: Iterator[list[ParameterSet]], cancelled: Callable[[], bool]) -> Run:
    for sets in chunks:
        if cancelled():
            return
        yield sets, context.measures(sets, 0)


def _elsewhere(workers: Workers, chunks: Iterator[list[ParameterSet]], cancelled: Callable[[], bool]) -> Run:
    """Chunks with their measures, in order. As many are on their way as keep every worker busy, and no more."""
    underway: deque[Any] = deque()
    try:
        while not cancelled():
            for sets in itertools.islice(chunks, AHEAD * workers.count - len(underway)):
                task = (_Context.measures, sets, 1)
                underway.append((workers.submit(*task), task))
            if not underway:
                return
            future, task = underway[0]
            measures = workers.result(future, *task, cancelled=cancelled)
            if measures is None:
                return
            underway.popleft()
            yield task[1], measures
    finally:
        for future, _ in underway:
            future.cancel()
