"""Measures of the motion that another washout computed."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _moris
from ._recording import columns_of, recording_of
from ._simulation import Simulation
from ._types import ParameterSet, RecordingOptions, Rig, Series, Source

if TYPE_CHECKING:
    from typing_extensions import Unpack


def measure(
    recording: Source,
    *,
    felt_force: Series | None = None,
    felt_rate: Series | None = None,
    pose: Series | None = None,
    legs: Series | None = None,
    washout: str | PathLike[str] | None = None,
    washout_map: str | PathLike[str] | None = None,
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    name: str | None = None,
    bound: bool = False,
    **options: Unpack[RecordingOptions],
) -> Simulation:
    """Judges the motion that any washout computed for a recording: the measures, findings, plot and report of a simulation.

    recording: as for simulate; it is faded in over 1 s unless fade_in says otherwise, and is what the rider should feel.
    felt_force: specific force in head axes, gravity's reaction included, (N, 3) [m/s2]. felt_rate: angular velocity in head
        axes, (N, 3) [rad/s]. legs: the six lengths from joint to joint, (N, 6) [m].
    pose: the platform's origin in the base frame and its roll, pitch and yaw, (N, 6) [m], [rad].
    Each is an array with a row for each sample of the recording, or n rows a step. Each may be a table, a dict or a file, too,
        with the columns that docs/your-washout.md lists. Other times are interpolated, which a finding says.
    washout: an FMU for co-simulation of FMI 2.0 or 3.0, stepped through the recording in place of series. washout_map: the file
        with its inputs and outputs, as docs/your-washout.md describes it.
    rig, parameters: as for Washout; of the parameters, the head, the washout location and the scale count.
    name: in the report; by default the file's. bound: compute the least error that any controller could reach, too.

    Without felt_force, forces and rates are those of the poses, or of the legs by forward kinematics, whose derivatives are
    finite differences over five samples. Limits are judged on the legs: those given, or those of the poses by inverse
    kinematics. Without either, `fits` is None.

    Returns a Simulation. Raises RecordingError where a series cannot be meant, with the argument and the remedy.
    """
    recording = recording_of(recording, options)
    given = (felt_force, felt_rate, pose, legs)
    paths = [Path(part).stem for part in given if isinstance(part, (str, PathLike))]
    parts = [_part(part) for part in given]
    fmu = None
    if washout is not None:
        if washout_map is None or any(part is not None for part in given):
            raise TypeError("a washout needs its washout_map, and no felt_force, felt_rate, pose or legs")
        fmu, paths = [washout, washout_map], [Path(washout).stem]
    name = name or (paths[0] if paths else "another washout")
    return Simulation(_moris.Simulation.judged(recording._native, rig, parameters, name, bound, parts, fmu), recording)


def _part(part: Any) -> Any:
    """Columns with names, a path, or an array."""
    if part is None:
        return None
    columns = columns_of(part)
    return part if columns is None else columns
