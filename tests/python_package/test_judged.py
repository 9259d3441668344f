"""Motion of another washout, judged by the package."""

import pickle

import moris
import numpy as np
import pytest
from conftest import gentle


@pytest.fixture(scope="module")
def fine():
    """A ride at the washout's own rate, and its simulation."""
    ride = gentle(12.0, 0.001)
    return ride, moris.simulate(ride, strategy="classical")


def differences(own, other):
    """By measure, of those that both know."""
    assert list(own.measures) == list(other.measures)
    pairs = ((name, value, other.measures[name]) for name, value in own.measures.items())
    return {name: abs(a - b) for name, a, b in pairs if a is not None and b is not None}


def felt(simulation):
    return {"felt_force": simulation["rider.specificForce"], "felt_rate": simulation["rider.angularVelocity"]}


def test_arrays_frames_and_files_have_the_measures_of_the_simulation_they_came_from(fine, tmp_path):
    import pandas

    ride, own = fine
    file = tmp_path / "felt.csv"
    columns = np.column_stack([own["time"], *felt(own).values()])
    np.savetxt(file, columns, delimiter=",", header="time,ax,ay,az,wx,wy,wz", comments="", fmt="%.17g")
    frame = pandas.read_csv(file)
    for given in (felt(own), dict.fromkeys(felt(own), file), dict.fromkeys(felt(own), frame), dict.fromkeys(felt(own), own.to_pandas())):
        judged = moris.measure(ride, **given)
        found = differences(own, judged)
        assert len(found) > 60 and max(found.values()) < 1e-9, max(found.items(), key=lambda item: item[1])
        assert judged.fits is None and "limits not judged" in repr(judged)
    assert moris.measure(ride, felt_force=file).name.startswith("recording, felt on")


def test_poses_and_legs_are_evaluated(fine):
    ride, own = fine
    pose = np.hstack([own["platform.position"], own["platform.orientation"]])
    for given in ({"pose": pose}, {"legs": own["actuator.length"]}):
        judged = moris.measure(ride, **given)
        found = {name: value for name, value in differences(own, judged).items() if name.endswith(("RMS error", "stroke used"))}
        assert len(found) > 10 and max(found.values()) < 1e-6, found
        assert judged.fits is True and np.allclose(judged["actuator.length"], own["actuator.length"], rtol=0, atol=1e-9)


def test_a_judged_motion_is_a_simulation(ride, tmp_path):
    own = moris.simulate(ride)
    judged = moris.measure(ride, **felt(own), legs=own["actuator.length"], name="mine", bound=True)
    assert np.array_equal(judged["time"], judged.time) and "mine on default rig" in judged.name
    assert judged.findings[0].startswith("The motion stays within the rig")
    assert any("bound" in row.name for row in judged.measures.rows) and judged.plot() is not None
    page = judged.report(tmp_path / "mine.html", compare=[own]).read_text(encoding="utf-8")
    assert "mine" in page and "default" in page
    again = pickle.loads(pickle.dumps(judged))
    assert again.measures == judged.measures and again.findings == judged.findings
    with pytest.raises(KeyError, match="there is no variable times"):
        own["times"]


def test_errors_name_the_argument_its_shape_and_the_remedy(ride):
    force = moris.simulate(ride)["rider.specificForce"]
    wrong = {
        r"felt_force has the shape \(3, 2001\), but must have \(2001, 3\).*transpose it": {"felt_force": force.T},
        r"felt_force has the shape \(500, 3\).*n \* 2000 \+ 1": {"felt_force": force[:500]},
        r"pose has the shape \(2001, 3\), but must have \(2001, 6\)": {"pose": force},
        "felt_force: there are no columns rider.specificForce.x to": {"felt_force": {"time": ride["time"], "a": ride["ax"]}},
        "give felt_force, pose or legs": {"felt_rate": force},
    }
    for message, given in wrong.items():
        with pytest.raises(moris.RecordingError, match=message):
            moris.measure(ride, **given)
    short = {"time": ride["time"][:501], **{name: force[:501, k] for k, name in enumerate(("ax", "ay", "az"))}}
    with pytest.raises(moris.RecordingError, match="covers 0 to 5 s, but the recording 0 to 20 s"):
        moris.measure(ride, felt_force=short)
    with pytest.raises(moris.RecordingError, match="no such file|cannot read"):
        moris.measure(ride, legs="nowhere.csv")


def test_wrong_units_and_other_rates_are_said(ride):
    own = moris.simulate(ride)
    force = own["rider.specificForce"]
    for wrong, words in ((force / 9.80665, "9.8 times too small"), (force * [-1, 1, 1], "Surge is felt with the wrong sign")):
        assert any(words in finding for finding in moris.measure(ride, felt_force=wrong).findings)
    coarse = {"time": ride["time"][::3], **{name: force[::3, k] for k, name in enumerate(("ax", "ay", "az"))}}
    judged = moris.measure(ride, felt_force=coarse)
    assert any("interpolated linearly" in finding for finding in judged.findings)
    assert np.abs(judged["rider.specificForce"] - force).max() < 1e-2
