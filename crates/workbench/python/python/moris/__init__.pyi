from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from threading import Event
from typing import Any, Literal, NamedTuple, TypedDict, Union, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

_Floats = NDArray[np.float64]
_Rig = Union[str, PathLike[str], Mapping[str, Any]]
_ParameterSet = Union[str, PathLike[str], Mapping[str, Any], Sequence["_ParameterSet"]]
_Strategy = Literal["classical", "adaptive", "optimal", "robust", "predictive"]
_Value = Union[float, bool, str]
_Source = Union["Recording", str, PathLike[str], Mapping[str, ArrayLike], Any]
_Show = Union[bool, None, Callable[[int, Union[int, None], str], Any]]

__all__ = [
    "AxisReach",
    "Bound",
    "BoundError",
    "BuildError",
    "ClusterError",
    "FrequencyResponse",
    "MEASURES",
    "Measure",
    "Measures",
    "MorisError",
    "NoFeasibleParameters",
    "Output",
    "Outputs",
    "ParameterError",
    "Recording",
    "RecordingError",
    "Result",
    "Simulation",
    "Survey",
    "Sweep",
    "Tuned",
    "Variable",
    "Washout",
    "__version__",
    "best",
    "bound",
    "build_fmu",
    "frequency_response",
    "parameters",
    "simulate",
    "survey",
    "sweep",
    "tune",
    "variables",
    "write_parameters",
]

__version__: str
MEASURES: dict[str, str]

class _RecordingOptions(TypedDict, total=False):
    format: str | None
    columns: Mapping[str, str] | None
    time_unit: Literal["s", "ms", "us", "ns"] | None
    force_unit: Literal["m/s2", "g", "mg"] | None
    rate_unit: Literal["rad/s", "deg/s"] | None
    angle_unit: Literal["rad", "deg"] | None
    speed_unit: Literal["m/s", "km/h", "mph", "kn"] | None
    gravity: Literal["included", "removed"] | None
    axes: Literal["forward-left-up", "forward-right-down"] | None
    mounting: Sequence[float] | Literal["auto"] | None
    rate_frame: Literal["body", "world"] | None
    empty_fields: Literal["error", "interpolate"] | None
    missing: Literal["error", "rest"] | None
    lap: int | None
    repair: bool | None
    resample: float | None
    fade_in: float | None

class MorisError(ValueError): ...

class ParameterError(MorisError):
    parameter: str | None
    value: _Value | None
    suggestions: tuple[str, ...]
    def __init__(
        self, message: str, parameter: str | None = None, value: _Value | None = None, suggestions: Iterable[str] = ()
    ) -> None: ...

class RecordingError(MorisError): ...
class BoundError(MorisError): ...
class NoFeasibleParameters(MorisError): ...
class BuildError(RuntimeError): ...

class ClusterError(RuntimeError):
    partial: Sweep | None
    def __init__(self, message: str, partial: Sweep | None = None) -> None: ...

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
    def __new__(cls, rig: _Rig | None = None, parameters: _ParameterSet | None = None, strategy: _Strategy | None = None) -> Washout: ...
    def step(
        self,
        dt: float,
        specific_force: Sequence[float] | _Floats | None = None,
        angular_velocity: Sequence[float] | _Floats | None = None,
        orientation: Sequence[float] | _Floats | None = None,
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
    def retune(self, parameters: _ParameterSet) -> None: ...
    def copy(self) -> Washout: ...
    def __copy__(self) -> Washout: ...
    def __deepcopy__(self, _memo: Any, /) -> Washout: ...
    def __getitem__(self, name: str, /) -> Any: ...
    def __eq__(self, other: object, /) -> bool: ...
    @property
    def output(self) -> Output: ...
    @property
    def parameters(self) -> dict[str, _Value]: ...

class Outputs(Mapping[str, NDArray[Any]]):
    time: _Floats
    array: _Floats
    names: tuple[str, ...]
    def __init__(self, time: _Floats, array: _Floats, names: Iterable[str]) -> None: ...
    def __getitem__(self, name: str) -> NDArray[Any]: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def to_pandas(self) -> Any: ...

class Variable(NamedTuple):
    name: str
    causality: str
    kind: str
    unit: str
    min: float
    max: float
    start: _Value | None
    items: tuple[str, ...]
    description: str
    vector: str

def variables(causality: Literal["input", "output", "parameter"] | None = None) -> dict[str, Variable]: ...

class Recording:
    def __init__(
        self,
        source: _Source,
        name: str | None = None,
        **options: Unpack[_RecordingOptions],
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def step(self) -> float: ...
    @property
    def duration(self) -> float: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def inputs(self) -> Outputs: ...
    def to_pandas(self) -> Any: ...

class Measure(NamedTuple):
    subject: str
    name: str
    value: float | None
    unit: str
    definition: str
    source: str

class Measures(dict[str, Union[float, None]]):
    rows: tuple[Measure, ...]
    def __missing__(self, name: str) -> float | None: ...
    def __init__(self, rows: Iterable[tuple[str, str, float | None, str, str, str]]) -> None: ...
    def to_pandas(self) -> Any: ...

class Simulation(Outputs):
    recording: Recording
    measures: Measures
    findings: list[str]
    parameters: dict[str, _Value]
    preview: float
    fits: bool
    name: str
    def __init__(self, native: Any, recording: Recording, preview: float = 0.0) -> None: ...
    @property
    def desired(self) -> tuple[_Floats, _Floats]: ...
    def plot(self, figure: Any = None) -> Any: ...
    def report(self, path: str | PathLike[str], compare: Iterable[Simulation] = ()) -> Path: ...

class Bound(NamedTuple):
    rms_error: float
    desired_rms: float
    felt: _Floats

def simulate(
    recording: _Source,
    rig: _Rig | None = None,
    parameters: _ParameterSet | None = None,
    strategy: _Strategy | None = None,
    *,
    bound: bool = False,
    preview: float = 0.0,
    **options: Unpack[_RecordingOptions],
) -> Simulation: ...
def bound(
    recording: _Source, rig: _Rig | None = None, parameters: _ParameterSet | None = None, **options: Unpack[_RecordingOptions]
) -> dict[str, Bound]: ...
def parameters(
    rig: _Rig | None = None, parameters: _ParameterSet | None = None, strategy: _Strategy | None = None
) -> dict[str, _Value]: ...
def write_parameters(
    path: str | PathLike[str], parameters: _ParameterSet, rig: _Rig | None = None, heading: str = "Written by moris"
) -> Path: ...

class FrequencyResponse:
    channels: tuple[str, ...]
    frequencies: _Floats
    ratios: NDArray[np.complex128]
    small: NDArray[np.complex128]
    distortion: _Floats
    limited: _Floats
    settled: NDArray[np.bool_]
    def __init__(self, channels: Iterable[str], frequencies: _Floats, test: Any, small: Any) -> None: ...
    def to_pandas(self) -> Any: ...
    def plot(self, figure: Any = None) -> Any: ...

def frequency_response(
    rig: _Rig | None = None,
    parameters: _ParameterSet | None = None,
    strategy: _Strategy | None = None,
    *,
    force: float = 1.0,
    rate: float | None = None,
    gravity_turns: bool = False,
) -> FrequencyResponse: ...

class AxisReach(NamedTuple):
    min: float
    max: float
    speed: float
    acceleration: float

class Survey:
    name: str
    reach: dict[str, AxisReach]
    volume: float
    tilted_volume: float
    smallest_singular_value: float | None
    worst_condition: float | None
    singular_at: list[float] | None
    closest_legs: tuple[int, int]
    leg_clearance: float
    def __init__(
        self, name: Any, axes: Any, volumes: Any, condition: Any, singular_at: Any, closest: Any, text: Any, picture: Any
    ) -> None: ...

def survey(rig: _Rig | None = None, samples: int = 1_000_000) -> Survey: ...
def build_fmu(
    rig: _Rig | None = None,
    parameters: _ParameterSet | None = None,
    strategy: _Strategy | None = None,
    *,
    output: str | PathLike[str] = ".",
    base: str | PathLike[str] | None = None,
    fmi: Literal[2, 3] | None = None,
    platforms: Sequence[str] | None = None,
    source: str | PathLike[str] | None = None,
) -> Path: ...

class Result:
    index: int
    parameters: Any
    values: _Floats
    error: str | None
    def __init__(self, index: int, parameters: Any, values: _Floats, error: str | None) -> None: ...
    def __getitem__(self, name: str) -> _Floats: ...

class Sweep:
    value: Any
    done: int
    complete: bool
    recordings: list[str]
    def __init__(self, value: Any, done: int, complete: bool, recordings: list[str]) -> None: ...
    def to_pandas(self) -> Any: ...

def best(count: int, cost: Callable[[Result], float]) -> Callable[[Any, Result], list[tuple[float, Result]]]: ...
def sweep(
    recordings: _Source | Iterable[_Source],
    parameter_sets: Iterable[_ParameterSet],
    reduce: Callable[[Any, Result], Any] | None = None,
    *,
    initial: Any = None,
    rig: _Rig | None = None,
    base: _ParameterSet | None = None,
    strategy: _Strategy | None = None,
    preview: float = 0.0,
    client: Any = None,
    chunk: int | None = None,
    progress: _Show = None,
    cancel: Event | None = None,
    **options: Unpack[_RecordingOptions],
) -> Sweep: ...

class Tuned:
    parameters: dict[str, _Value]
    changed: dict[str, _Value]
    summary: str
    verdict: str
    is_worse: bool
    interrupted: bool
    errors: dict[str, dict[str, float | None]]
    def __init__(
        self,
        before: Any,
        parameters: Any,
        summary: Any,
        verdict: Any,
        is_worse: Any,
        interrupted: Any,
        errors: Any,
        rig: Any,
    ) -> None: ...
    def save(self, path: str | PathLike[str]) -> Path: ...
    def to_pandas(self) -> Any: ...

def tune(
    recordings: _Source | Iterable[_Source],
    rig: _Rig | None = None,
    parameters: _ParameterSet | None = None,
    strategy: _Strategy | None = None,
    *,
    hold_out: _Source | Iterable[_Source] = (),
    folds: int | None = None,
    groups: Sequence[str] = ("splitter", "angular", "scale", "strategy"),
    weights: Sequence[float] = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0),
    stroke_reserve: float = 0.01,
    comfort: Sequence[float] = (0.2, 4.0, 4.0),
    evaluations: int = 3000,
    seed: int = 1,
    progress: _Show = None,
    patience: int | None = None,
    stop: Callable[[str, int, float | None], bool] | None = None,
    client: Any = None,
    **options: Unpack[_RecordingOptions],
) -> Tuned: ...
