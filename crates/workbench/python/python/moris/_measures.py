"""The measures of a simulation."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import Any, Dict, NamedTuple, Union

from ._optional import pandas
from ._variables import near_misses


class Measure(NamedTuple):
    """One measure of cue quality."""

    subject: str
    """`specific force x`, `sensed angular velocity y`, `platform`, ..."""
    name: str
    """`RMS error`, `false cues`, ..."""
    value: float | None
    """In `unit`; None where the measure is not defined for this recording."""
    unit: str
    definition: str
    source: str


class Measures(Dict[str, Union[float, None]]):
    """Measures by subject and name, each a number: `measures["specific force x RMS error"]` [m/s2].

    rows: the measures in order, each with its unit, definition and source.
    """

    rows: tuple[Measure, ...]

    def __init__(self, rows: Iterable[tuple[str, str, float | None, str, str, str]]) -> None:
        self.rows = tuple(Measure(*row) for row in rows)
        super().__init__((f"{row.subject} {row.name}", row.value) for row in self.rows)

    def __missing__(self, name: str) -> float | None:
        raise KeyError(f"there is no measure {name}; {near_misses(name, self)}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.rows,)

    def to_pandas(self) -> Any:
        """The measures as a pandas.DataFrame, a row each."""
        return pandas().DataFrame(self.rows, columns=Measure._fields)

    def _repr_html_(self) -> str:
        cells = "".join(
            f"<tr title='{escape(row.definition)}'><td>{escape(row.subject)}</td><td>{escape(row.name)}</td>"
            f"<td>{'–' if row.value is None else f'{row.value:.4g}'}</td><td>{escape(row.unit)}</td></tr>"
            for row in self.rows
        )
        return f"<table><tr><th>subject</th><th>measure</th><th>value</th><th>unit</th></tr>{cells}</table>"
