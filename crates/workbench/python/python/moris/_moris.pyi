# Types of the compiled module; crates/workbench/python/src has the functions and their texts.

from collections.abc import Callable, Iterator, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, final

from numpy.typing import ArrayLike, NDArray

from ._outputs import Outputs
from ._types import Floats, ParameterSet, Rig, Strategy, Value

__all__ = [
    "FADE_IN",
    "Output",
    "Recording",
    "Simulation",
    "Tuning",
    "VERSION",
    "Washout",
    "bound",
    "fit",
    "frequency_response",
    "pack_fmu",
    "parameter_file",
    "parameter_values",
    "presets",
    "rigs",
    "survey",
    "sweep_chunk",
    "sweep_measures",
    "variable_rows",
]

VERSION: str

def presets() -> list[str]: ...
def rigs() -> list[str]: ...

FADE_IN: float

@final
class Output:
    def __getitem__(self, name: str, /) -> Any: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: str, /) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]: ...
    def values(self) -> list[Any]: ...
    def items(self) -> list[tuple[str, Any]]: ...

@final
class Washout:
    def __new__(cls, rig: Rig | None = None, parameters: ParameterSet | None = None, strategy: Strategy | None = None) -> Washout: ...
    def step(
        self,
        dt: float,
        specific_force: Sequence[float] | Floats | None = None,
        angular_velocity: Sequence[float] | Floats | None = None,
        orientation: Sequence[float] | Floats | None = None,
        speed: float = 0.0,
        lean: float = 0.0,
        engaged: bool = True,
        *,
        preview: ArrayLike | None = None,
        preview_step: float | None = None,
        nan: Literal["error", "rest"] = "error",
    ) -> Output: ...
    def run(
        self,
        time: ArrayLike,
        specific_force: ArrayLike,
        angular_velocity: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        speed: ArrayLike | None = None,
        lean: ArrayLike | None = None,
        engaged: ArrayLike | None = None,
        *,
        preview: ArrayLike | None = None,
        preview_step: float | None = None,
        inputs: Literal["slopes", "values"] = "slopes",
        nan: Literal["error", "rest"] = "error",
    ) -> Outputs: ...
    def retune(self, parameters: ParameterSet) -> None: ...
    def copy(self) -> Washout: ...
    def __copy__(self) -> Washout: ...
    def __deepcopy__(self, _memo: Any, /) -> Washout: ...
    def __getitem__(self, name: str, /) -> Any: ...
    def __eq__(self, other: object, /) -> bool: ...
    @property
    def output(self) -> Output: ...
    @property
    def parameters(self) -> dict[str, Value]: ...

@final
class Recording:
    @staticmethod
    def read(file: str | PathLike[str], options: dict[str, Any]) -> Recording: ...
    @staticmethod
    def of_columns(name: str, columns: Sequence[tuple[str, ArrayLike]], options: dict[str, Any]) -> Recording: ...
    def facts(self) -> tuple[str, float, float, list[str]]: ...
    def samples(self) -> tuple[Floats, Floats, list[str]]: ...

@final
class Simulation:
    def __new__(
        cls,
        recording: Recording,
        rig: Rig | None,
        parameters: ParameterSet | None,
        strategy: Strategy | None,
        bound: bool,
        preview: float,
        learn: bool,
        road: str | PathLike[str] | None,
    ) -> Simulation: ...
    @staticmethod
    def judged(
        recording: Recording,
        rig: Rig | None,
        parameters: ParameterSet | None,
        name: str,
        bound: bool,
        parts: Sequence[Any],
        washout: Sequence[str | PathLike[str]] | None,
    ) -> Simulation: ...
    def judgement(
        self,
    ) -> tuple[
        list[str], dict[str, Value], bool | None, list[tuple[str, str, float | None, str, str, str]]
    ]: ...
    def verdict(self) -> tuple[str, list[str], dict[str, Value] | None]: ...
    def samples(self) -> tuple[Floats, Floats, list[str]]: ...
    def desired_rates(self) -> Floats: ...
    def html(self, others: Sequence[Simulation]) -> str: ...

@final
class Tuning:
    def __new__(
        cls,
        recordings: Sequence[Recording],
        held_out: int,
        rig: Rig | None,
        parameters: ParameterSet | None,
        strategy: Strategy | None,
        groups: Sequence[str],
        weights: Sequence[float],
        stroke_reserve: float,
        comfort: Sequence[float],
        objective: str,
    ) -> Tuning: ...
    def costs(self, names: Sequence[str], values: Any) -> list[Any] | None: ...
    def run(
        self,
        evaluations: int,
        seed: int,
        folds: int,
        patience: int | None,
        observe: Callable[[str, int, float | None], bool],
        evaluate: Callable[..., Any] | None,
        parallel: int,
    ) -> tuple[dict[str, Value], str, str, bool, bool, list[tuple[str, float, float | None, float | None]]]: ...

def bound(recording: Recording, rig: Rig | None, parameters: ParameterSet | None) -> list[tuple[float, float, Floats] | None]: ...
def fit(
    recording: Recording, rig: Rig | None, parameters: ParameterSet | None, strategy: Strategy | None, preview: float, error: float, inverted: float
) -> tuple[Any, bool, list[Any], dict[str, Value]]: ...
def frequency_response(
    rig: Rig | None, parameters: ParameterSet | None, strategy: Strategy | None, force: float, rate: float, gravity_turns: bool, platform: bool
) -> tuple[list[str], Floats, tuple[Any, Floats, Floats, Any], tuple[Any, Floats, Floats, Any]]: ...
def pack_fmu(base: str | PathLike[str], parameters: str, output: str | PathLike[str]) -> Path: ...
def parameter_file(heading: str, rig: Rig | None, parameters: ParameterSet | None) -> str: ...
def parameter_values(rig: Rig | None, parameters: ParameterSet | None, strategy: Strategy | None) -> dict[str, Value]: ...
def survey(rig: Rig | None, samples: int) -> tuple[str, list[Any], Any, Any, list[float] | None, Any, str, str]: ...
def sweep_chunk(
    recordings: Sequence[Recording],
    rig: Rig | None,
    sets: Sequence[ParameterSet],
    strategy: Strategy | None,
    preview: float,
    threads: int,
) -> tuple[NDArray[Any], list[str | None]]: ...
def sweep_measures() -> list[tuple[str, str, str]]: ...
def variable_rows() -> list[Any]: ...
