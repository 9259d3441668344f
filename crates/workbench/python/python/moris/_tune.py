"""Tuning: the workbench's search for better parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

from . import _moris
from . import _types as types
from ._errors import NoFeasibleParameters
from ._executor import Workers
from ._optional import pandas
from ._progress import Progress
from ._recording import recordings_of
from ._simulation import write_parameters
from ._types import ParameterSet, RecordingOptions, Rig, Show, Sources, Strategy, Value

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(eq=False, repr=False)
class Tuned:
    """Tuned parameters and what they come to.

    parameters: dict of all parameters. changed: those that the search has changed.
    summary: the whole result as Markdown. verdict: its first sentence. is_worse: True where the tuned parameters are worse
        on a recording by more than 5 %, or in the mean over those that they were not tuned on.
    errors: for each recording a dict with `before`, `tuned` and `unseen`: the objective, 0 perfect and 1 a platform at
        rest; None where there is none. interrupted: True if the search was ended early.
    strategies: with strategy="all" the Tuned of each strategy by name, with this one as the best; otherwise empty.
    """

    parameters: dict[str, Value]
    changed: dict[str, Value]
    summary: str
    verdict: str
    is_worse: bool
    interrupted: bool
    errors: dict[str, dict[str, float | None]]
    strategies: dict[str, Tuned]
    _rig: Rig | None

    @property
    def error(self) -> float:
        """The mean error, on recordings not tuned on where there are any."""
        unseen = [of["unseen"] for of in self.errors.values() if of["unseen"] is not None]
        errors = unseen or [of["tuned"] for of in self.errors.values() if of["tuned"] is not None]
        return sum(errors) / len(errors)

    def save(self, path: types.Path) -> Path:
        """Writes the parameter file, for the workbench and for `cargo build-fmu --parameters`; returns the path."""
        return write_parameters(path, self.parameters, self._rig, heading=self.verdict)

    def to_pandas(self) -> Any:
        """The errors as a pandas.DataFrame, a row for each recording."""
        return pandas().DataFrame.from_dict(self.errors, orient="index")

    def __repr__(self) -> str:
        return f"Tuned({len(self.changed)} parameters changed; {self.verdict})"

    def _repr_markdown_(self) -> str:
        return self.summary


def tune(
    recordings: Sources,
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    strategy: Strategy | Literal["all"] | None = None,
    *,
    hold_out: Sources = (),
    folds: int | None = None,
    groups: Sequence[str] = ("splitter", "angular", "scale", "strategy"),
    weights: Sequence[float] = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0),
    stroke_reserve: float = 0.01,
    comfort: Sequence[float] = (0.2, 4.0, 4.0),
    objective: Literal["shape", "error"] = "shape",
    evaluations: int = 3000,
    seed: int = 1,
    progress: Show = None,
    patience: int | None = None,
    stop: Callable[[str, int, float | None], bool] | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    **options: Unpack[RecordingOptions],
) -> Tuned:
    """Searches for parameters with a good shape of the felt force on all recordings, such that no limit is active.

    With the right sign and at the right time first, as large as can be then.

    recordings: to tune on. hold_out: recordings to try the result on only. folds: number of groups of recordings that are
        left out in turn, which decides how far the result goes from the initial parameters; by default each recording by
        itself. 0 leaves none out, and the result goes all the way to the best parameters for the recordings.
    rig, parameters, strategy: as for Washout; the search starts from these parameters. With strategy="all" each strategy is
        tuned, and the result is the one with the least error.
    groups: parameters that may change: "splitter", "angular", "scale", "cutoff", "tilt", "strategy", "order". Those of
        "strategy" are weights, gains and poles of the strategy in use; the classical one has none. The "order" is that of the
        high-passes of the splitter and the angular channel.
    weights: of the sensed errors of specific force x, y, z and angular velocity x, y, z; the first two weigh the shapes of
        surge and sway, too. objective: "shape", or "error" for the sensed error alone. stroke_reserve: of each actuator [m].
    comfort: bounds of the felt force's shake, jolt and peak [m/s2], at least their values with the initial parameters.
    evaluations: parameter sets of each search after its coarse scan. seed: of the random numbers.
    progress: True, False, None or a function of (done, total, text).
    patience: evaluations without a smaller error after which a search ends. stop: function of (search, evaluations, error)
        that returns True to end them all. Both, and Ctrl-C, keep the best so far.
    executor, workers: as for sweep. The result is the same to the bit.

    docs/tuning-by-search.md has the objective.
    Returns Tuned. Raises NoFeasibleParameters where none keep the limits.
    """
    if strategy == "all":
        given = (recordings_of(recordings, options), rig, parameters)
        fixed: dict[str, Any] = dict(
            hold_out=recordings_of(hold_out, options), folds=folds, groups=groups, weights=weights, stroke_reserve=stroke_reserve,
            comfort=comfort, objective=objective, evaluations=evaluations, seed=seed, progress=progress, patience=patience,
            stop=stop, executor=executor, workers=workers,
        )  # fmt: skip
        return _best(lambda one: tune(*given, one, **fixed))
    tuned_on = recordings_of(recordings, options)
    held_out = recordings_of(hold_out, options)
    recordings = tuned_on + held_out
    if not tuned_on:
        raise ValueError("recordings is empty; give one at least")
    names = [recording.name for recording in recordings]
    double = next((name for name in names if names.count(name) > 1), None)
    if double is not None:
        raise ValueError(f"two recordings are called {double}; give each a name of its own: moris.Recording(..., name=...)")
    for name, value, least in (("evaluations", evaluations, 1), ("patience", patience, 1), ("folds", folds, 0), ("seed", seed, 0)):
        if value is not None and value < least:
            raise ValueError(f"{name} is {value}, but must be {least} at least")
    folds = len(tuned_on) if folds is None else folds
    arguments = (
        [recording._native for recording in recordings], len(held_out), rig, parameters, strategy, list(groups), list(weights), stroke_reserve,
        list(comfort), objective,
    )  # fmt: skip
    tuning = _moris.Tuning(*arguments)
    remote = None if executor is None else Workers(executor, workers, _moris.Tuning, arguments)
    searches = 1 + (min(folds, len(tuned_on)) if len(tuned_on) > 1 else 0)
    costs = _moris.Tuning.costs
    bar = Progress(progress, searches * evaluations, "tuning", "set")
    begun: list[str] = []

    def observe(search: str, tried: int, error: float | None) -> bool:
        if search not in begun:
            begun.append(search)
        done = begun.index(search) * evaluations + min(tried, evaluations)
        bar.to(done, f"{search}: {'none fits yet' if error is None else f'error {error:.4f}'}")
        return stop is None or not stop(search, tried, error)

    try:
        tuned, summary, verdict, is_worse, interrupted, found = tuning.run(
            evaluations,
            seed,
            folds,
            patience,
            observe,
            None if remote is None else lambda *given: remote.result(remote.submit(costs, *given), costs, *given),
            0 if remote is None else max(16, 2 * remote.count),
        )
    finally:
        bar.close()
    before = _moris.parameter_values(rig, parameters, strategy)
    changed = {name: value for name, value in tuned.items() if before[name] != value}
    errors = {name: {"before": old, "tuned": new, "unseen": unseen} for name, old, new, unseen in found}
    return Tuned(tuned, changed, summary, verdict, is_worse, interrupted, errors, {}, rig)


def _best(tune_one: Callable[[Strategy], Tuned]) -> Tuned:
    """The strategy with the least error; strategies whose search finds nothing do not count."""
    found: dict[str, Tuned] = {}
    nothing: Exception | None = None
    for strategy in get_args(Strategy):
        try:
            found[strategy] = tune_one(strategy)
        except NoFeasibleParameters as error:
            nothing = error
            continue
        if found[strategy].interrupted:
            break
    if not found:
        raise nothing or ValueError("there is no strategy")
    best = min(found.values(), key=lambda tuned: tuned.error)
    best.strategies = found
    return best
