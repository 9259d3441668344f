"""Recordings: tables, dicts of arrays, and files."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _moris
from ._errors import RecordingError
from ._optional import need
from ._outputs import Outputs
from ._types import RecordingOptions, Source, Sources

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Recording:
    """A recorded ride, in the washout's frames and units and at equal steps.

    source: a table, a dict of arrays of shape (N,), or the path of a file. Tables are a pandas.DataFrame, one of polars, a
        pyarrow.Table, another with __arrow_c_stream__ or __dataframe__, and a structured array such as FMPy's result. Files
        are CSV (also .csv.gz), Parquet, Excel, MATLAB (.mat) or MDF (.mf4). A directory of CSV files, or a list of them, is joined by time. The columns are time,
        ax, ay, az (specific force) and wx, wy, wz (angular velocity) at the rider's head, and, where there are any, roll,
        pitch, yaw, speed and lean. Units in the brackets of a name are read: "ax [g]". A DataFrame whose index is called
        time needs no such column.
    name: of the recording; by default the file's, without extension.
    format: name of a logger's format, such as "phyphox"; `moris simulate --help` lists them.
    columns: names that are not these, {"ax": "accel_x"} or "ax=accel_x,ay=accel_y"; signs and sums as in docs/recordings.md.
    time_unit: "s", "ms", "us", "ns", "min", "h", "d". force_unit: "m/s2", "g", "mg", "ft/s2". rate_unit: "rad/s", "deg/s".
    angle_unit: "rad", "deg". speed_unit: "m/s", "km/h", "mph", "kn", "ft/s".
    length_unit: "m", "km", "ft". position: True reads the columns x and y, or latitude and
        longitude, for simulate(learn=True).
    gravity: "included" as an accelerometer reads it, or "removed".
    axes: "forward-left-up", "forward-right-down" or "forward-right-up". rate_frame, force_frame: "body" or "world".
    mounting: [roll, pitch, yaw] of the sensor in the vehicle [deg], or "auto".
    empty_fields: "error" or "interpolate"; those of a table are NaN. repair: True to interpolate over a logger's error values and spikes.
    missing: "error", or "rest" to take ay az wx wy wz that the source lacks as at rest. lap: number of the lap to read where
        time starts again with each.
    rate: samples a second of a source without times. resample: samples a second, to interpolate a recording whose steps are unequal.
    fade_in: seconds over which the recording is faded in from rest: 1 by default, 0 to take it as it is.

    step: time between samples [s]. duration: time from the first sample to the last [s]. warnings: in sentences.

    Raises RecordingError where columns are missing or the units or axes are implausible, with the remedy.
    """

    name: str
    step: float
    duration: float
    warnings: list[str]

    def __init__(self, source: Source, name: str | None = None, **options: Unpack[RecordingOptions]) -> None:
        unknown = [option for option in options if option not in RecordingOptions.__annotations__]
        if unknown:
            raise TypeError(f"there is no option {unknown[0]}; there are {', '.join(RecordingOptions.__annotations__)}")
        given = {"fade_in": _moris.FADE_IN, **{option: value for option, value in options.items() if value is not None}}
        self._native = source if isinstance(source, _moris.Recording) else _read(source, name, given)
        self.name, self.step, self.duration, self.warnings = self._native.facts()

    @property
    def inputs(self) -> Outputs:
        """The washout's inputs at each sample, by the names of the FMU's variables: Outputs."""
        return Outputs(*self._native.samples())

    def to_pandas(self) -> Any:
        """The inputs as a pandas.DataFrame with the time [s] as its index."""
        return self.inputs.to_pandas()

    def __repr__(self) -> str:
        return f"Recording({self.name!r}, {self.duration:g} s at {1 / self.step:g} Hz)"


def recording_of(source: Source, options: RecordingOptions) -> Recording:
    """The recording itself, or one read with these options."""
    if isinstance(source, Recording):
        given = [option for option, value in options.items() if value is not None]
        if given:
            raise TypeError(f"{given[0]} is for sources that are still to be read; give it to moris.Recording")
        return source
    return Recording(source, **options)


def recordings_of(sources: Sources, options: RecordingOptions) -> list[Recording]:
    """A list of recordings, of one source or of several; those that are not read yet are read with these options."""
    is_one = isinstance(sources, (Recording, str, PathLike, dict)) or _is_table(sources)
    several: Any = [sources] if is_one else sources
    return [source if isinstance(source, Recording) else Recording(source, **options) for source in several]


def _read(source: Any, name: str | None, options: dict[str, Any]) -> _moris.Recording:
    if isinstance(source, (list, tuple)):
        source = "+".join(str(path) for path in source)
    columns = columns_of(source)
    if columns is None:
        raise TypeError(f"a recording is a table, a dict of arrays or a path, not {type(source).__name__}")
    if isinstance(columns, Path):
        if columns.suffix.lower() in READERS:
            raise RecordingError(f"cannot read {columns}: there is no such file")
        return _moris.Recording.read(columns, options)
    default = Path(source).stem if isinstance(source, (str, PathLike)) else "recording"
    return _moris.Recording.of_columns(name or default, columns, options)


def columns_of(source: Any) -> list[tuple[str, np.ndarray[Any, Any]]] | Path | None:
    """The columns of a table, a dict or a file with a reader; the path of any other file; None of what is no such source."""
    if isinstance(source, (str, PathLike)):
        path = Path(source)
        reader = READERS.get(path.suffix.lower())
        if reader is None or not path.exists():
            return path
        source = reader(path)
    elif _is_table(source):
        source = _columns_of_table(source)
    if not hasattr(source, "items"):
        return None
    return [(str(key), _numbers(values)) for key, values in source.items()]


def _is_table(source: Any) -> bool:
    if isinstance(source, np.ndarray):
        return source.dtype.names is not None
    return _is_pandas(source) or hasattr(source, "__arrow_c_stream__") or hasattr(source, "__dataframe__")


def _is_pandas(source: Any) -> bool:
    return hasattr(source, "columns") and hasattr(source, "index") and hasattr(source, "iloc")


def _columns_of_table(table: Any) -> dict[str, Any]:
    if isinstance(table, np.ndarray):
        return {name: table[name] for name in table.dtype.names}
    if _is_pandas(table):
        return _columns_of_frame(table)
    kind = f"a {type(table).__name__}"
    if hasattr(table, "__arrow_c_stream__"):
        arrow = need("pyarrow", kind).table(table)
        return {name: arrow[name].to_numpy() for name in arrow.column_names}
    return _columns_of_frame(need("pandas", kind).api.interchange.from_dataframe(table))


def _numbers(values: Any) -> np.ndarray[Any, Any]:
    # A column of text is one that is not used: its numbers are missing, and only that of a column in use matters.
    values = np.asarray(values)
    if values.dtype.kind in "mM":
        values = (values - values[0]) / np.timedelta64(1, "s") if values.dtype.kind == "M" else values / np.timedelta64(1, "s")
    try:
        return np.asarray(values, dtype=float).reshape(-1)
    except (TypeError, ValueError):
        return np.full(len(values), np.nan)


def _array(series: Any) -> Any:
    # Times with a zone are those of UTC.
    return series.to_numpy(dtype="datetime64[ns]") if getattr(series.dtype, "tz", None) else series.to_numpy()


def _columns_of_frame(frame: Any) -> dict[str, Any]:
    columns = {name: _array(frame[name]) for name in frame.columns}
    index = frame.index
    if str(index.name).lower().startswith("time") and not any(str(name).lower().startswith("time") for name in columns):
        columns = {str(index.name): _array(index), **columns}
    return columns


def _parquet(path: Path) -> dict[str, Any]:
    need("pyarrow", "a Parquet file")
    return _columns_of_frame(need("pandas", "a Parquet file").read_parquet(path))


def _excel(path: Path) -> dict[str, Any]:
    if path.suffix.lower() == ".xls":
        need("xlrd", "an old Excel workbook")
    else:
        need("openpyxl", "an Excel workbook")
    return _columns_of_frame(need("pandas", "an Excel workbook").read_excel(path))


def _matlab(path: Path) -> dict[str, Any]:
    io = need("scipy.io", "a MATLAB file")
    try:
        values = io.loadmat(path, squeeze_me=True, struct_as_record=True)
    except NotImplementedError:
        raise RecordingError(f"{path} is a MATLAB 7.3 file; save it with save(..., '-v7') in MATLAB") from None
    columns = {}
    for name, value in values.items():
        if name.startswith("__"):
            continue
        value = np.asarray(value)
        if value.dtype.names:  # a struct of signals
            columns.update({field: np.atleast_1d(value[field].item()) for field in value.dtype.names})
        else:
            columns[name] = np.atleast_1d(value)
    longest = max((max(value.shape) for value in columns.values() if value.ndim in (1, 2)), default=0)
    found = {}
    for name, value in columns.items():
        if value.shape == (longest,):
            found[name] = value
        elif value.ndim == 2 and longest in value.shape:
            # A matrix, of samples by axes or the other way round: a column of each axis.
            rows = value.T if value.shape[0] == longest else value
            found.update({f"{name}_{axis + 1}": row for axis, row in enumerate(rows)})
    return found


def _mdf(path: Path) -> dict[str, Any]:
    mdf = need("asammdf", "an MDF measurement").MDF(path)
    try:
        # Channels of several rates are brought onto the times of the fastest, linearly.
        frame = mdf.to_dataframe(time_from_zero=False, use_interpolation=True)
        units = {}
        for name in frame.columns:
            group, index = mdf.whereis(name)[0] if mdf.whereis(name) else (None, None)
            units[name] = mdf.get_channel_unit(name, group=group, index=index) if group is not None else ""
    finally:
        mdf.close()
    columns = {"time [s]": frame.index.to_numpy()}
    for name in frame.columns:
        title = f"{name} [{units[name]}]" if units[name] and "[" not in name else name
        columns[title] = frame[name].to_numpy()
    return columns


READERS: dict[str, Callable[[Path], dict[str, Any]]] = {
    ".parquet": _parquet,
    ".xlsx": _excel,
    ".xlsm": _excel,
    ".xls": _excel,
    ".mat": _matlab,
    ".mf4": _mdf,
    ".mdf": _mdf,
}
