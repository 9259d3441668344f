"""The largest scale that a rig gives the right way round."""

import moris
import numpy as np
import pytest
from conftest import STANDARD_GRAVITY


@pytest.fixture(scope="module")
def slalom():
    """A ride that is too hard at its own size."""
    time = np.arange(3001) * 0.01
    fade = np.clip(time / 2, 0, 1)
    still = np.zeros_like(time)
    forces = {"ax": still, "ay": 4.0 * fade * np.sin(1.6 * time), "az": STANDARD_GRAVITY + still}
    return moris.Recording({"time": time, **forces, "wx": still, "wy": still, "wz": still}, name="slalom")


def test_a_smaller_scale_has_the_right_sign_and_shape(slalom):
    found = moris.fit(slalom, strategy="predictive")
    best = found.best
    assert found.fits and 0.1 < best.scale < 0.9 and best.breaks == 1.0
    assert best.surge is None and best.sway.shape > 0.8 and best.sway.inverted <= 0.02 and best.error <= 0.5
    scales = [one.scale for one in found.curve]
    assert scales == sorted(scales, reverse=True) and scales[0] == 1.0
    assert found.curve[0].sway.shape < best.sway.shape
    own = moris.parameters(strategy="predictive")["scale.specificForce.y"]
    assert found.parameters["scale.specificForce.y"] == pytest.approx(own * best.scale)
    assert list(found.to_pandas().columns) == ["scale", "breaks", "heave", "error", "surge", "sway"]
    assert "sway" in repr(found)
    felt = moris.simulate(slalom, parameters=found.parameters)["rider.specificForce.y"]
    assert np.corrcoef(felt, slalom.inputs["vehicle.specificForce.y"])[0, 1] > 0.8


def test_the_file_has_the_parameters(slalom, tmp_path):
    found = moris.fit(slalom, strategy="classical", error=0.8, inverted=0.05)
    own = moris.parameters(strategy="classical")["splitter.y.omega1"]
    assert found.parameters["splitter.y.omega1"] == pytest.approx(own * found.best.breaks)
    assert moris.parameters(parameters=found.save(tmp_path / "fit.toml")) == found.parameters


@pytest.mark.parametrize("given", [{"error": 0.0}, {"inverted": 1.5}, {"preview": 9.0}])
def test_an_aim_out_of_range_is_named(slalom, given):
    (name,) = given
    with pytest.raises(ValueError, match=f"{name} is "):
        moris.fit(slalom, **given)
