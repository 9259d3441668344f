"""Simulations of recordings, and the bound."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _moris
from . import _types as types
from ._measures import Measures
from ._outputs import Outputs
from ._plot import plot
from ._recording import Recording, recording_of
from ._types import Floats, ParameterSet, RecordingOptions, Rig, Source, Strategy, Value

if TYPE_CHECKING:
    from typing_extensions import Unpack

AXES = {"x": "surge", "y": "sway", "z": "heave"}


class Bound(NamedTuple):
    """The least RMS error of specific force on an axis that any controller with full preview could reach."""

    rms_error: float
    """[m/s2]"""
    desired_rms: float
    """RMS of the desired specific force as a deviation from rest [m/s2]: the error of a platform that stands still."""
    felt: Floats
    """Felt specific force of the best trajectory, as a deviation from rest, (N,) [m/s2]."""


class Simulation(Outputs):
    """A simulated recording: every input and output at each sample, and the measures.

    time: (N,) [s]. Inputs and outputs by the names of the FMU's variables, as in Outputs.
    recording: the Recording. measures: Measures.
    preview: time of the recording that was previewed [s]. learned: True with a preview learned by the position. parameters: dict of all parameters. fits: False where
        a safety unit or an actuator's limit was active, or soft limits for more than 1 % of the time; None where no
        limits were judged.
    """

    recording: Recording
    measures: Measures
    parameters: dict[str, Value]
    preview: float
    learned: bool
    fits: bool | None
    name: str

    def __init__(self, native: _moris.Simulation, recording: Recording, preview: float = 0.0, learned: bool = False) -> None:
        super().__init__(*native.samples())
        self._native = native
        self.recording = recording
        self.preview = preview
        self.learned = learned
        (rig_name, parameters_name), self.parameters, self.fits, measures = native.judgement()
        self.measures = Measures(measures)
        previewed = ", learned preview" if learned else f", preview of {preview:g} s" if preview else ""
        self.name = f"{recording.name}, {parameters_name} on {rig_name}{previewed}"

    @cached_property
    def _verdict(self) -> tuple[str, list[str], dict[str, Value] | None]:
        return self._native.verdict()

    @property
    def verdict(self) -> str:
        """The most important fault, the size that is left, and what to change; alternatives are simulated for it."""
        return self._verdict[0]

    @property
    def findings(self) -> list[str]:
        """Sentences, the most important first."""
        return self._verdict[1]

    @property
    def advice(self) -> dict[str, Value] | None:
        """All parameters that the verdict recommends; None where it recommends none."""
        return self._verdict[2]

    @property
    def desired(self) -> tuple[Floats, Floats]:
        """Desired specific force and angular velocity in head axes: two arrays of shape (N, 3) [m/s2], [rad/s]."""
        return self["vehicle.specificForce"], self._native.desired_rates()

    def plot(self, figure: Any = None) -> Any:
        """Draws felt over desired specific force and angular velocity, and the actuators; returns the matplotlib figure."""
        return plot(self, figure)

    def report(self, path: types.Path, compare: Iterable[Simulation] = ()) -> Path:
        """Writes the report, one HTML page without external files.

        path: of the page. compare: other simulations of the same recording, shown beside this one. Returns the path.
        """
        path = Path(path)
        if path.suffix.lower() not in (".html", ".htm"):
            raise ValueError(f"path is {path}, but a report is a page: name it with .html")
        page = self._native.html([other._native for other in compare])
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(page, encoding="utf-8")
        return path

    def __reduce__(self) -> tuple[Any, ...]:
        return Simulation, (self._native, self.recording, self.preview, self.learned)

    def __repr__(self) -> str:
        fits = {True: "fits the rig", False: "does not fit the rig", None: "limits not judged"}[self.fits]
        return f"Simulation({self.name!r}: {len(self.time)} samples, {fits})"

    def _repr_html_(self) -> str:
        findings = "".join(f"<li>{escape(finding)}</li>" for finding in self.findings)
        return f"<b>{escape(self.name)}</b><p><b>{escape(self.verdict)}</b></p><ul>{findings}</ul>{_picture(self)}{self.measures._repr_html_()}"


def _picture(simulation: Simulation) -> str:
    """The plot as an image in HTML; nothing where there is no matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    image = io.BytesIO()
    simulation.plot(Figure(figsize=(9, 6), layout="constrained")).savefig(image, format="png", dpi=80)
    return f'<img alt="felt over desired motion" src="data:image/png;base64,{base64.b64encode(image.getvalue()).decode()}">'


def simulate(
    recording: Source,
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    strategy: Strategy | None = None,
    *,
    bound: bool = False,
    preview: float = 0.0,
    learn: bool | types.Path = False,
    **options: Unpack[RecordingOptions],
) -> Simulation:
    """Simulates a recording from rest at neutral, the inputs going linearly from sample to sample.

    recording: a Recording, or what one is made of: a DataFrame, a dict of arrays or a path; `options` are those of
        Recording. rig, parameters, strategy: as for Washout.
    bound: compute the least error that any controller could reach, too; it takes some seconds.
    preview: time of the recording's own future that the washout knows at each sample, from 0 to 4 [s]. Only the strategy
        "predictive" makes use of it.
    learn: give it a preview that is learned from earlier passes of the same road instead. The source needs the columns x and y, or
        latitude and longitude; a Recording is read with position=True. The path of a file, one for each vehicle and track, keeps
        what is learned: it is read first and written at the end.

    Returns a Simulation. Raises RecordingError, ParameterError or BoundError.
    """
    road = None if isinstance(learn, bool) else learn
    learns = learn is not False
    if learns and not isinstance(recording, Recording):
        options["position"] = True
    recording = recording_of(recording, options)
    native = _moris.Simulation(recording._native, rig, parameters, strategy, bound, preview, learns, road)
    return Simulation(native, recording, preview, learns)


def bound(
    recording: Source, rig: Rig | None = None, parameters: ParameterSet | None = None, **options: Unpack[RecordingOptions]
) -> dict[str, Bound]:
    """The least RMS error of specific force that any controller with full preview could reach on this rig.

    Returns a dict from "surge", "sway" and "heave" to Bound, without the axes on which nothing is desired. Computed for an
    upright rider. docs/measures.md has the definition. Raises BoundError where the recording is too short.
    """
    recording = recording_of(recording, options)
    bounds = _moris.bound(recording._native, rig, parameters)
    return {axis: Bound(*found) for axis, found in zip(AXES.values(), bounds) if found is not None}


def parameters(
    rig: Rig | None = None, parameters: ParameterSet | None = None, strategy: Strategy | None = None
) -> dict[str, Value]:
    """Every parameter by name, a dict: the defaults, with a rig, presets, files and dicts laid over them."""
    return _moris.parameter_values(rig, parameters, strategy)


def write_parameters(
    path: types.Path, parameters: ParameterSet, rig: Rig | None = None, heading: str = "Written by moris"
) -> Path:
    """Writes a parameter file for `cargo build-fmu --parameters` and the workbench: the values that are not the rig's own.

    path: of the file. parameters: as for Washout. rig: the rig on which they are used. Returns the path.
    """
    path = Path(path)
    path.write_text(_moris.parameter_file(heading, rig, parameters), encoding="utf-8")
    return path
