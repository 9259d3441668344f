"""Washouts beside each other: the strategies, and other people's."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, get_args

from ._optional import pandas
from ._plot import plot_felt
from ._recording import Recording, recording_of
from ._simulation import Simulation, simulate
from ._types import ParameterSet, RecordingOptions, Rig, Source, Strategy

if TYPE_CHECKING:
    from typing_extensions import Unpack

COLUMNS = (
    *(f"specific force {axis} {name}" for axis in "xy" for name in ("shape", "size", "inverted", "RMS error", "jolt")),
    "platform smallest stroke margin",
)
"""Measures in the table of a comparison."""
SHOWN = ("shape", "size", "inverted", "RMS error")
"""Those of its text, of surge and sway."""


class Comparison(list[Simulation]):
    """Simulations of one recording or several: a list, with a table and a picture."""

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with a row for each simulation: shape, size, inverted time [%], error and jolt of surge and sway."""
        rows = [{"recording": one.recording.name, "washout": one.name} | {name: one.measures[name] for name in COLUMNS} for one in self]
        return pandas().DataFrame(rows).set_index(["recording", "washout"])

    def plot(self, figure: Any = None) -> Any:
        """Draws the felt surge and sway of each washout over the desired one, a row a recording; returns the matplotlib figure."""
        return plot_felt(self, figure)

    def __str__(self) -> str:
        shown = [f"{name} %" if name == "inverted" else name for name in SHOWN]
        rows = [["recording", "washout", *(f"{axis} {name}" for axis in ("surge", "sway") for name in shown)]]
        for one in self:
            values = [one.measures[f"specific force {axis} {name}"] for axis in "xy" for name in SHOWN]
            rows.append([one.recording.name, one.name, *("-" if value is None else f"{value:.3g}" for value in values)])
        widths = [max(map(len, column)) for column in zip(*rows)]
        return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)

    def _repr_html_(self) -> str:
        return str(self.to_pandas().to_html(float_format="%.3g"))


def compare(
    recordings: Source | Iterable[Source],
    others: Mapping[str, Callable[[Recording], Simulation]] | None = None,
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    strategies: Iterable[Strategy] = get_args(Strategy),
    **options: Unpack[RecordingOptions],
) -> Comparison:
    """Simulates recordings with several strategies, and judges other washouts beside them.

    recordings: one, or a list of them, as for simulate. rig, parameters: as for Washout, for every strategy. strategies: all
        by default.
    others: functions of a Recording that return a Simulation, by the name of their washout; most call measure with the motion
        of another washout.

    Returns a Comparison. Raises ValueError for another washout with a strategy's name, and as simulate and measure do.
    """
    strategies = list(strategies)
    for name in others or {}:
        if name in strategies:
            raise ValueError(f"others has a washout {name!r}, which is the name of a strategy; give it another name")
    sources = recordings if isinstance(recordings, (list, tuple)) else [recordings]
    found = Comparison()
    for source in sources:
        recording = recording_of(source, options)
        for strategy in strategies:
            found.append(_named(strategy, simulate(recording, rig, parameters, strategy)))
        found.extend(_named(name, judge(recording)) for name, judge in (others or {}).items())
    return found


def _named(name: str, simulation: Simulation) -> Simulation:
    simulation.name = name
    return simulation
