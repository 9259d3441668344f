"""Types of arguments that several functions have."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from ._recording import Recording

Path = Union[str, "PathLike[str]"]
Floats = NDArray[np.float64]
Value = Union[float, bool, str]
Strategy = Literal["classical", "adaptive", "optimal", "predictive", "robust"]
Rig = Union[Path, Mapping[str, Any]]
ParameterSet = Union[Path, Mapping[str, Any], Sequence["ParameterSet"]]
# A table of any library is a source, too.
Source = Union["Recording", Path, Mapping[str, ArrayLike], Any]
# Samples of vectors: an array, or a table or file with named columns.
Series = Union[ArrayLike, Path, Mapping[str, ArrayLike], Any]
Sources = Union[Source, Iterable[Source]]
Show = Union[bool, None, Callable[[int, Union[int, None], str], Any]]


class RecordingOptions(TypedDict, total=False):
    """Options of Recording, which describes them; None is the default of each."""

    format: str | None
    columns: Mapping[str, str] | str | None
    time_unit: Literal["s", "ms", "us", "ns", "min", "h", "d"] | None
    force_unit: Literal["m/s2", "g", "mg", "ft/s2"] | None
    rate_unit: Literal["rad/s", "deg/s"] | None
    angle_unit: Literal["rad", "deg"] | None
    speed_unit: Literal["m/s", "km/h", "mph", "kn", "ft/s"] | None
    length_unit: Literal["m", "km", "ft"] | None
    position: bool | None
    gravity: Literal["included", "removed"] | None
    axes: Literal["forward-left-up", "forward-right-down", "forward-right-up"] | None
    mounting: Sequence[float] | Literal["auto"] | None
    rate_frame: Literal["body", "world"] | None
    force_frame: Literal["body", "world"] | None
    empty_fields: Literal["error", "interpolate"] | None
    missing: Literal["error", "rest"] | None
    lap: int | None
    repair: bool | None
    rate: float | None
    resample: float | None
    fade_in: float | None
