"""The example beside a vehicle, at 100 Hz and at 1 kHz."""

import numpy as np
from conftest import example


def test_the_example_beside_a_vehicle_is_the_same_at_100_hz_and_at_1_khz(fmu):
    beside = example("03_beside_a_vehicle")
    results = {rate: beside.simulate(fmu, rate) for rate in (100, 1000)}
    for _time, desired, outputs in results.values():
        felt, lengths, tilt_rates = outputs[:, :3], outputs[:, 4:10], outputs[:, 10:]
        assert lengths.min() > 1.0 and lengths.max() < 1.6
        assert np.max(np.abs(np.degrees(tilt_rates))) <= np.degrees(0.05236) + 1e-9
        for axis in range(2):
            assert np.corrcoef(felt[:, axis], desired[:, axis])[0, 1] > 0.97
    slow, fast = results[100][2], results[1000][2]
    assert np.max(np.abs(slow[:, 4:10] - fast[9::10, 4:10])) < 1e-3
