"""The documented example, at both rates that it speaks of."""

import importlib.util

import numpy as np
import pytest

from conftest import ROOT


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("ride", ROOT / "examples" / "fmpy" / "ride.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_ride_is_the_same_at_100_hz_and_at_1_khz(example, fmu, tmp_path):
    rides = {rate: example.ride(fmu, rate) for rate in (100, 1000)}
    for rate, (times, desired, outputs) in rides.items():
        lengths = outputs[:, 6:12]
        assert lengths.min() > 1.0 and lengths.max() < 1.6
        assert np.max(np.abs(np.degrees(outputs[:, 12:14]))) <= 3.0 + 1e-9
        # The default set tilts by 13.8 degrees at most, and by 2.6 degrees a second.
        assert np.corrcoef(outputs[:, 0], desired[:, 0])[0, 1] > 0.95
        picture = tmp_path / f"ride_{rate}.png"
        example.draw(picture, times, desired, outputs, rate)
        assert picture.stat().st_size > 10_000
    slow, fast = rides[100], rides[1000]
    at_slow_times = fast[2][9::10]
    assert np.max(np.abs(slow[2][:, 6:12] - at_slow_times[:, 6:12])) < 1e-3
