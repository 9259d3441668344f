"""Exceptions. Each message names the variable, the value, the reason and the remedy."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from ._types import Value

if TYPE_CHECKING:
    from ._sweep import Sweep


class MorisError(ValueError):
    """Base of the exceptions of this package."""


class ParameterError(MorisError):
    """A rig, a parameter or a combination of them cannot be used.

    parameter: name of the parameter, or None. value: its value, or None. suggestions: names that look like a wrong one.
    """

    parameter: str | None
    value: Value | None
    suggestions: tuple[str, ...]

    def __init__(self, message: str, parameter: str | None = None, value: Value | None = None, suggestions: Iterable[str] = ()) -> None:
        super().__init__(message, parameter, value, tuple(suggestions))
        self.parameter = parameter
        self.value = value
        self.suggestions = tuple(suggestions)

    def __str__(self) -> str:
        return str(self.args[0])


class RecordingError(MorisError):
    """A recording or an array of samples cannot be used."""


class BoundError(MorisError):
    """No bound can be computed of a recording."""


class NoFeasibleParameters(MorisError):
    """A search found no parameters with which every recording keeps the limits."""


class ExecutorError(RuntimeError):
    """An executor lost a task. `partial` holds what was done until then."""

    partial: Sweep | None

    def __init__(self, message: str, partial: Sweep | None = None) -> None:
        super().__init__(message)
        self.partial = partial


class BuildError(RuntimeError):
    """The FMU cannot be made: the base cannot be used, the toolchain or the sources are missing, or cargo failed."""
