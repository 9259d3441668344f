"""The largest scale that a rig gives the right way round."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _moris
from . import _types as types
from ._optional import pandas
from ._recording import recording_of
from ._simulation import write_parameters
from ._types import ParameterSet, RecordingOptions, Rig, Source, Strategy, Value

if TYPE_CHECKING:
    from typing_extensions import Unpack


class AxisShape(NamedTuple):
    """Shape of the felt specific force of an axis, below 2 Hz."""

    shape: float
    """Correlation of felt and desired force."""
    inverted: float
    """Fraction of the time in which a force that is felt has the wrong sign."""
    size: float
    """RMS of the felt force over that of the desired one."""


class Candidate(NamedTuple):
    """Factors on the parameters, and the shape with them."""

    scale: float
    """Factor on the specific force of surge and sway and on all rates."""
    breaks: float
    """Factor on the classical strategy's break frequencies of surge and sway."""
    heave: float
    """Factor on the specific force of heave."""
    error: float | None
    """Shape error at that scale, surge and sway together."""
    surge: AxisShape | None
    """None where the recording does not move along the axis."""
    sway: AxisShape | None
    """The same for sway."""


class Fit:
    """The largest scale that reaches the aims, or the one nearest to them.

    best: Candidate. fits: True if it reaches the aims. curve: candidates with its break frequencies, the largest scale first.
    parameters: dict of all parameters, with the factors of `best` applied.
    """

    best: Candidate
    fits: bool
    curve: list[Candidate]
    parameters: dict[str, Value]

    def __init__(self, best: Any, fits: bool, curve: Any, parameters: dict[str, Value], rig: Rig | None) -> None:
        self.best = _candidate(best)
        self.fits = fits
        self.curve = [_candidate(one) for one in curve]
        self.parameters = parameters
        self._rig = rig

    def save(self, path: types.Path) -> Path:
        """Writes the parameter file, for the workbench and for `cargo build-fmu --parameters`; returns the path."""
        return write_parameters(path, self.parameters, self._rig, heading=repr(self))

    def to_pandas(self) -> Any:
        """The curve as a pandas.DataFrame, a row for each candidate."""
        return pandas().DataFrame(self.curve)

    def __repr__(self) -> str:
        axes = [(name, axis) for name, axis in (("surge", self.best.surge), ("sway", self.best.sway)) if axis]
        shapes = ", ".join(f"{name} {axis.shape:.2f} ({100 * axis.inverted:.1f} % inverted)" for name, axis in axes)
        return f"Fit(scale {self.best.scale:.2f}{'' if self.fits else ', which does not fit'}: shape of {shapes or 'nothing'})"


def _candidate(given: Any) -> Candidate:
    (scale, breaks, heave), error, axes = given
    surge, sway = (AxisShape(*axis) if axis else None for axis in axes)
    return Candidate(scale, breaks, heave, error, surge, sway)


def fit(
    recording: Source,
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    strategy: Strategy | None = None,
    *,
    preview: float = 0.0,
    error: float = 0.5,
    inverted: float = 0.02,
    **options: Unpack[RecordingOptions],
) -> Fit:
    """Finds the largest scale at which the felt specific force has the right sign and proportion.

    One factor scales surge, sway and all rates, heave has its own; the classical strategy gets a further one on its break
    frequencies. recording: as for simulate. rig, parameters, strategy: as for Washout. preview: of the recording's own force,
    for the predictive strategy [s]. error: largest shape error of surge and sway together. inverted: largest fraction of
    inverted time of either. options: as for Recording.

    Returns Fit. docs/measures.md defines shape, size and inverted time.
    """
    native = recording_of(recording, options)
    return Fit(*_moris.fit(native._native, rig, parameters, strategy, float(preview), float(error), float(inverted)), rig)
