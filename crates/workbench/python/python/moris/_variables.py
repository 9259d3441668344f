"""The table of the washout's variables."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Literal, NamedTuple

from . import _moris
from ._types import Value


class Variable(NamedTuple):
    """A variable of the washout, as in the FMU."""

    name: str
    causality: str
    """`input`, `output` or `parameter`."""
    kind: str
    """`real`, `integer`, `boolean` or `enumeration`."""
    unit: str
    """SI unit; empty for none."""
    min: float
    max: float
    start: Value | None
    """Value by default; None for outputs."""
    items: tuple[str, ...]
    """Items of an enumeration."""
    description: str
    vector: str
    """Name of the vector that it is an element of, its own for none: `platform.position` for `platform.position.x`."""
    usual: tuple[float, float] | None
    """Range of practice; None where there is none."""
    group: str | None
    """Group with which `tune` changes it; None for what is not tuned."""


VARIABLES = {row[0]: Variable._make([*row[:7], tuple(row[7]), *row[8:]]) for row in _moris.variable_rows()}


def variables(causality: Literal["input", "output", "parameter"] | None = None) -> dict[str, Variable]:
    """The variables as a dict from name to Variable; of one causality where it is given.

    causality: "input", "output" or "parameter".
    """
    if causality not in (None, "input", "output", "parameter"):
        raise ValueError(f"causality is {causality!r}, but must be 'input', 'output' or 'parameter'")
    return {name: row for name, row in VARIABLES.items() if causality in (None, row.causality)}


def near_misses(name: str, names: Iterable[str]) -> str:
    """The end of a message about a wrong name: those that look most like it."""
    found = difflib.get_close_matches(name, list(names))
    return f"did you mean {' or '.join(found)}?" if found else f"there are {', '.join(names)}"
