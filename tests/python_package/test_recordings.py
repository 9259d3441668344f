"""Recordings from tables, dicts and files, by the workbench's import code."""

import pickle
import re
import subprocess

import moris
import numpy as np
import pandas
import pytest
from conftest import ROOT, STANDARD_GRAVITY, gentle

NAMES = ["time", "ax", "ay", "az", "wx", "wy", "wz"]


def inputs(recording):
    return recording.inputs.array


@pytest.fixture
def frame(ride):
    return pandas.DataFrame(ride)


@pytest.fixture
def expected(ride):
    return inputs(moris.Recording(ride))


def test_a_dict_a_frame_and_a_csv_file_are_the_same_recording(ride, frame, expected, tmp_path):
    frame.to_csv(tmp_path / "ride.csv", index=False)
    frame.to_csv(tmp_path / "packed.csv.gz", index=False)
    read = [
        moris.Recording(frame),
        moris.Recording(frame.set_index("time")),
        moris.Recording(tmp_path / "ride.csv"),
        moris.Recording(str(tmp_path / "packed.csv.gz")),
    ]
    for recording in read:
        assert np.array_equal(inputs(recording), expected)
    assert [recording.name for recording in read] == ["recording", "recording", "ride", "packed"]
    columns = moris.Recording(ride, fade_in=0.0).inputs
    assert np.array_equal(columns["vehicle.specificForce"], np.column_stack([ride["ax"], ride["ay"], ride["az"]]))
    assert np.array_equal(columns["vehicle.angularVelocity.z"], ride["wz"])
    assert np.allclose(columns.time, ride["time"], rtol=0, atol=1e-12)


class Stream:
    """A table that is known by Arrow's stream alone, as one of polars."""

    def __init__(self, table):
        self.table = table

    def __arrow_c_stream__(self, requested_schema=None):
        return self.table.__arrow_c_stream__(requested_schema)


class Interchange:
    """A table that is known by the dataframe interchange protocol alone."""

    def __init__(self, frame):
        self.frame = frame

    def __dataframe__(self, **options):
        return self.frame.__dataframe__(**options)


def test_tables_of_other_packages_are_the_same_recording(ride, frame, expected):
    import pyarrow

    structured = np.zeros(len(ride["time"]), dtype=[(name, float) for name in NAMES])
    for name in NAMES:
        structured[name] = ride[name]
    arrow = pyarrow.table({**ride, "remark": ["a"] * len(structured)})
    for table in (structured, arrow, Stream(arrow), Interchange(frame)):
        assert np.array_equal(inputs(moris.Recording(table)), expected)
        assert moris.sweep(table, [{}], reduce=lambda found, result: 1.0).done == 1
    with pytest.raises(TypeError, match="a recording is a table, a dict of arrays or a path, not ndarray"):
        moris.Recording(np.zeros((5, 7)))


def test_times_with_a_zone_and_missing_values_of_a_frame(frame, expected):
    zoned = frame.assign(time=pandas.Timestamp("2026-05-01", tz="Europe/Berlin") + pandas.to_timedelta(frame["time"], unit="s"))
    indexed = zoned.set_index("time")
    for table in (zoned, indexed):
        assert np.allclose(inputs(moris.Recording(table)), expected, rtol=0, atol=1e-6)
    missing = frame.copy()
    missing.loc[300:303, "ax"] = np.nan
    with pytest.raises(moris.RecordingError, match='line 301, column ax: is NaN; .* use empty_fields="interpolate"'):
        moris.Recording(missing)
    found = inputs(moris.Recording(missing, empty_fields="interpolate"))
    between = np.interp(np.arange(300, 304), [299, 304], expected[[299, 304], 0])
    assert np.allclose(found[300:304, 0], between, rtol=0, atol=1e-12)
    assert np.array_equal(np.delete(found, range(300, 304), axis=0), np.delete(expected, range(300, 304), axis=0))


def test_parquet_excel_matlab_and_mdf_files(ride, frame, expected, tmp_path):
    import scipy.io

    frame.to_parquet(tmp_path / "ride.parquet")
    frame.to_excel(tmp_path / "ride.xlsx", index=False)
    scipy.io.savemat(tmp_path / "ride.mat", {**ride, "fs": 100.0})
    scipy.io.savemat(tmp_path / "struct.mat", {"ride": ride})
    for name in ("ride.parquet", "ride.xlsx", "ride.mat", "struct.mat"):
        recording = moris.Recording(tmp_path / name)
        assert np.allclose(inputs(recording), expected, rtol=1e-14, atol=1e-15), name
        assert recording.name == name.split(".")[0]
    # A matrix of samples by axes, and one of axes by samples.
    force, rate = (np.array([ride[name] for name in names]) for names in (NAMES[1:4], NAMES[4:7]))
    scipy.io.savemat(tmp_path / "matrices.mat", {"time": ride["time"], "acc": force.T, "gyr": rate})
    columns = {name: f"{'acc' if k < 3 else 'gyr'}_{k % 3 + 1}" for k, name in enumerate(NAMES[1:7])}
    found = inputs(moris.Recording(tmp_path / "matrices.mat", columns=columns))
    assert np.allclose(found[:, :6], expected[:, :6], rtol=1e-14, atol=1e-15)


def test_an_mdf_file_has_units_and_several_rates(ride, expected, tmp_path):
    asammdf = pytest.importorskip("asammdf", reason="needs asammdf: pip install asammdf")
    mdf = asammdf.MDF()
    fast = [asammdf.Signal(ride[name], ride["time"], name=name, unit="m/s2") for name in NAMES[1:4]]
    slow = [asammdf.Signal(np.degrees(ride[name])[::2], ride["time"][::2], name=name, unit="deg/s") for name in NAMES[4:]]
    mdf.append(fast)
    mdf.append(slow)
    mdf.save(tmp_path / "ride.mf4")
    mdf.close()
    recording = moris.Recording(tmp_path / "ride.mf4")
    found = inputs(recording)
    assert np.allclose(found[:, :3], expected[:, :3], rtol=0, atol=1e-12)
    # Every other sample of the rates is interpolated.
    assert np.allclose(found[::2, 3:6], expected[::2, 3:6], rtol=0, atol=1e-12)
    assert np.allclose(found[:-1, 3:6], expected[:-1, 3:6], rtol=0, atol=1e-4)


def test_units_and_axes_are_converted(ride, expected):
    given = {"t [ms]": 1e3 * ride["time"], "ax": ride["ax"] / STANDARD_GRAVITY, "ay": -ride["ay"] / STANDARD_GRAVITY}
    given["az"] = -ride["az"] / STANDARD_GRAVITY
    given.update({"gx": np.degrees(ride["wx"]), "gy": -np.degrees(ride["wy"]), "gz": -np.degrees(ride["wz"])})
    recording = moris.Recording(
        given,
        columns={"time": "t", "wx": "gx", "wy": "gy", "wz": "gz"},
        force_unit="g",
        rate_unit="deg/s",
        axes="forward-right-down",
    )
    assert np.allclose(inputs(recording), expected, rtol=1e-13, atol=1e-13)
    in_g = {**ride, "ax": ride["ax"] / STANDARD_GRAVITY}
    assert np.allclose(inputs(moris.Recording(in_g, columns="ax=ax * 9.80665")), expected, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize(
    ("change", "options", "message"),
    [
        ({"wz": None}, {}, 'there is no column wz; there are time, ax, .*columns={"wz": "NAME"}'),
        ({"az": lambda az: az / STANDARD_GRAVITY}, {}, 'which is gravity in g, not in m/s2: use force_unit="g"'),
        ({"az": lambda az: -az}, {}, 'so z points down: use axes="forward-right-down"'),
        ({"az": lambda az: az - STANDARD_GRAVITY}, {}, 'so gravity has been taken out: use gravity="removed"'),
        ({"time": lambda t: t + 0.005 * (t > 5)}, {}, "do not come at equal steps.*resample=100 interpolates"),
        ({"ay": lambda ay: np.where(ay > 0.3, np.nan, ay)}, {}, "column ay: is NaN; cut this part off"),
        ({}, {"force_unit": "G"}, "unknown variant `G`, expected one of `m/s2`, `g`, `mg`"),
        ({}, {"columns": ["ax"]}, 'columns must be names by key, or a text such as "time=t,ax=accel_x"'),
        ({}, {"resample": 0.1}, "resample is 0.1, but must be from 1 to 10000"),
        ({"ax": lambda ax: ax[:-1]}, {}, "values, others have"),
    ],
)
def test_what_cannot_be_is_refused_with_the_argument_that_helps(ride, change, options, message):
    for name, act in change.items():
        ride[name] = None if act is None else act(ride[name])
    ride = {name: values for name, values in ride.items() if values is not None}
    with pytest.raises(moris.RecordingError, match=message):
        moris.Recording(ride, **options)


def test_messages_name_arguments_and_not_the_options_of_the_command(ride):
    ride["ay"] = ride["ay"].copy()
    ride["ay"][len(ride["ay"]) // 2] += 40.0
    ride["ax"] = ride["ax"] + 2.0
    warnings = " ".join(moris.Recording(ride, fade_in=0.0).warnings)
    assert "use repair=True to interpolate" in warnings and "fade_in=1 fades it in" in warnings
    again = {name: np.concatenate([values, values]) for name, values in ride.items()}
    with pytest.raises(moris.RecordingError, match="use lap=1 to lap=2 to read one of them"):
        moris.Recording(again)


# A change of each column that a recording has, or none to leave it out, the options, and a part of what is said.
DAMAGES = [
    ({"wz": None}, {}, 'columns={"wz": "NAME"}'),
    ({"time": lambda t: 1e-6 * t}, {}, 'columns={"time": "NAME * 1000"}'),
    ({"time": lambda t: 1e3 * t}, {}, "give it with time_unit"),
    ({"time": lambda t: np.round(t, 1)}, {}, "resample="),
    ({"time": lambda t: t % 5}, {}, "use lap=1"),
    ({"time": lambda t: t % 5}, {"lap": 9}, "another lap"),
    ({"az": lambda az: 16384 * az / STANDARD_GRAVITY}, {}, '"az": "az / 16'),
    ({"az": lambda az: az - STANDARD_GRAVITY}, {}, 'gravity="removed"'),
    ({"az": lambda az: az - STANDARD_GRAVITY}, {"mounting": "auto"}, 'mounting="auto" finds no gravity'),
    ({"ay": lambda ay: ay + 7.0, "az": lambda az: az - 3.0}, {}, 'mounting="auto"'),
    ({"ax": lambda ax: ax + 2.0}, {"fade_in": 0.0}, "fade_in=1"),
    ({"ax": lambda ax: np.where(np.arange(len(ax)) == 300, 40.0, ax)}, {}, "repair=True"),
    ({"ax": lambda ax: np.where(np.arange(len(ax)) == 300, np.nan, ax)}, {}, "is NaN; cut this part off"),
    ({"wz": lambda wz: 600 * wz}, {}, 'rate_unit="deg/s"'),
    ({"ax": lambda ax: ax}, {"columns": {"ax": "wx"}}, "with columns"),
]


@pytest.mark.parametrize(("change", "options", "message"), DAMAGES)
def test_what_is_said_of_a_damaged_recording_has_no_option_of_the_command(ride, change, options, message):
    for name, act in change.items():
        ride[name] = None if act is None else act(ride[name])
    try:
        said = " ".join(moris.Recording({name: values for name, values in ride.items() if values is not None}, **options).warnings)
    except moris.RecordingError as error:
        said = str(error)
    assert message in said
    assert not re.search(r"--|[\ufdd0-\ufdef]|\b(time|force|rate|angle|speed|length)-unit|fade-in|empty-fields", said), said


def test_what_is_no_recording_is_refused(tmp_path):
    with pytest.raises(TypeError, match="a recording is a table, a dict of arrays or a path, not int"):
        moris.Recording(7)
    with pytest.raises(TypeError, match="there is no option forse_unit"):
        moris.Recording({}, forse_unit="g")
    for name in ("no.csv", "no.parquet", "no.mf4"):
        with pytest.raises(moris.RecordingError, match="cannot read .*no"):
            moris.Recording(tmp_path / name)


def test_a_missing_package_is_named_with_the_line_that_installs_it(monkeypatch, tmp_path):
    import builtins

    real = builtins.__import__
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    (tmp_path / "ride.parquet").write_bytes(b"PAR1")
    with pytest.raises(ImportError, match="a Parquet file needs the package pyarrow: pip install pyarrow"):
        moris.Recording(tmp_path / "ride.parquet")
    assert builtins.__import__ is real


def test_a_recording_is_pickled_with_everything(ride):
    recording = moris.Recording({**ride, "roll": 0.0 * ride["time"], "pitch": 0.1 * np.sin(ride["time"])}, name="mine", rate_frame="world")
    again = pickle.loads(pickle.dumps(recording))
    assert (again.name, again.step, again.warnings) == (recording.name, recording.step, recording.warnings)
    assert np.array_equal(inputs(again), inputs(recording))
    assert np.array_equal(moris.simulate(again).array, moris.simulate(recording).array)


def test_the_command_reads_the_same(ride, frame, tmp_path):
    """`moris simulate` and `moris.simulate` give the same measures."""
    import json

    frame.to_csv(tmp_path / "ride.csv", index=False)
    command = ["cargo", "moris", "simulate", str(tmp_path / "ride.csv"), "--json", "--no-bound", "--report", str(tmp_path / "report")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode in (0, 3), done.stderr
    expected = json.loads(done.stdout)[0]["results"][0]
    simulation = moris.simulate(tmp_path / "ride.csv")
    assert simulation.fits == expected["fits"] and simulation.findings == expected["findings"]
    assert [(row.subject, row.name, row.value) for row in simulation.measures.rows] == [
        (row["subject"], row["name"], row["value"]) for row in expected["measures"]
    ]


def test_several_lengths_of_ride_have_their_own_duration():
    assert moris.Recording(gentle(7.0)).duration == pytest.approx(7.0, abs=1e-12)


def test_files_of_one_ride_are_joined_and_a_turned_sensor_is_turned_back(ride, tmp_path):
    frame = pandas.DataFrame(ride)
    turned = frame.assign(ax=frame["ay"], ay=-frame["ax"], wx=frame["wy"], wy=-frame["wx"])
    turned[["time", "ax", "ay", "az"]].to_csv(tmp_path / "force.csv", index=False)
    turned[["time", "wx", "wy", "wz"]].to_csv(tmp_path / "rate.csv", index=False)
    expected = inputs(moris.Recording(ride))
    for source in ([tmp_path / "force.csv", tmp_path / "rate.csv"], tmp_path):
        assert np.allclose(inputs(moris.Recording(source, mounting=[0, 0, 90])), expected, atol=1e-9)
    with pytest.raises(moris.RecordingError, match='use format="phyphox"'):
        names = ["Acceleration x", "Acceleration y", "Acceleration z", "Gyroscope x", "Gyroscope y", "Gyroscope z"]
        units = ["(m/s^2)"] * 3 + ["(rad/s)"] * 3
        renamed = dict(zip(NAMES, ["Time (s)", *(f"{name} {unit}" for name, unit in zip(names, units))]))
        moris.Recording(frame.rename(columns=renamed))
