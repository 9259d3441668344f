"""Series of variables, sampled together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._optional import pandas
from ._types import Floats
from ._variables import VARIABLES, near_misses


class Outputs(Mapping[str, NDArray[Any]]):
    """Samples of variables, by the names of the FMU's variables.

    A single variable is an array of shape (N,): `outputs["actuator[1].length"]`. A vector is an array with a column for
    each element, under the name without index or component: `outputs["actuator.length"]` has the shape (N, 6),
    `outputs["platform.position"]` the shape (N, 3). Flags are arrays of bool. Units are SI.

    time: (N,) [s], also `outputs["time"]`. array: (N, number of variables), all columns as floats. names: of the columns.
    """

    time: Floats
    array: Floats
    names: tuple[str, ...]

    def __init__(self, time: Floats, array: Floats, names: Iterable[str]) -> None:
        self.time = time
        self.array = array
        self.names = tuple(names)
        self._columns: dict[str, list[int]] = {}
        for column, name in enumerate(self.names):
            self._columns[name] = [column]
            vector = VARIABLES[name].vector
            if vector != name:
                self._columns.setdefault(vector, []).append(column)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name == "time":
            return self.time
        if name not in self._columns:
            raise KeyError(f"there is no variable {name}; {near_misses(name, self._columns)}")
        columns = self._columns[name]
        series = self.array[:, columns[0] : columns[-1] + 1]
        if name in self.names:
            series = series[:, 0]
        kind = VARIABLES[self.names[columns[0]]].kind
        return series.astype({"boolean": bool, "integer": int}[kind]) if kind in ("boolean", "integer") else series

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        duration = self.time[-1] - self.time[0] if len(self.time) else 0.0
        return f"{type(self).__name__}({len(self.time)} samples over {duration:g} s, {len(self)} variables)"

    def to_pandas(self) -> Any:
        """The samples as a pandas.DataFrame: a column for each single variable, the index is time [s]."""
        frame = pandas().DataFrame({name: self[name] for name in self.names})
        frame.index = pandas().Index(np.asarray(self.time), name="time")
        return frame
