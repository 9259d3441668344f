"""The frequency response."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _moris
from ._optional import pandas
from ._plot import plot_response
from ._types import Floats, ParameterSet, Rig, Strategy


class FrequencyResponse:
    """Felt sines on each channel, over the desired ones.

    channels: names of the six channels: surge, sway, heave [m/s2], roll rate, pitch rate, yaw rate [rad/s].
    frequencies: (12,) [rad/s].
    ratios: (6 inputs, 12 frequencies, 6 outputs), complex, with the test's amplitudes, SI units. small: the same with a
        thousandth of them, which shows the linear filters.
    distortion: (6, 12, 6), what is felt beside the sine, as a fraction of it.
    limited: (6, 12, 3), fractions of the time in which tilt coordination, a safety unit, the actuator guard were limited.
    settled: (6, 12), False where the response did not become periodic.
    """

    channels: tuple[str, ...]
    frequencies: Floats
    ratios: NDArray[np.complex128]
    small: NDArray[np.complex128]
    distortion: Floats
    limited: Floats
    settled: NDArray[np.bool_]

    def __init__(self, channels: Iterable[str], frequencies: Floats, test: Any, small: Any) -> None:
        self.channels = tuple(channels)
        self.frequencies = frequencies
        self.ratios, self.distortion, self.limited, self.settled = test
        self.small = small[0]

    def to_pandas(self) -> Any:
        """The responses as a pandas.DataFrame: a row for each input, frequency and output."""
        rows = [
            (name, frequency, output, abs(ratio), np.degrees(np.angle(ratio)), abs(small), np.degrees(np.angle(small)))
            for name, of_input, of_small in zip(self.channels, self.ratios, self.small)
            for frequency, of_frequency, of_small_frequency in zip(self.frequencies, of_input, of_small)
            for output, ratio, small in zip(self.channels, of_frequency, of_small_frequency)
        ]
        columns = ["input", "frequency", "output", "modulus", "phase", "small modulus", "small phase"]
        return pandas().DataFrame(rows, columns=columns)

    def plot(self, figure: Any = None) -> Any:
        """Draws modulus and phase of the direct channels; returns the matplotlib figure."""
        return plot_response(self, figure)

    def __repr__(self) -> str:
        low, high = self.frequencies[0], self.frequencies[-1]
        return f"FrequencyResponse({len(self.channels)} channels, {low:g} to {high:.3g} rad/s)"


def frequency_response(
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    strategy: Strategy | None = None,
    *,
    force: float = 1.0,
    rate: float | None = None,
    gravity_turns: bool = False,
    platform: bool = False,
) -> FrequencyResponse:
    """Measures the frequency response of the whole washout, after ICAO Doc 9625's objective motion cueing test.

    rig, parameters, strategy: as for Washout. force: amplitude of the specific force [m/s2]. rate: amplitude of the angular
    velocity [rad/s], by default 1 deg/s; an angle of six times and an angular acceleration of ten times as much bound it.
    gravity_turns: the vehicle's orientation follows its roll and pitch rates. platform: the nominal platform with its drives
    moves by the commands, not exactly as commanded. Returns a FrequencyResponse. It uses all cores.
    """
    rate = float(np.radians(1.0)) if rate is None else rate
    return FrequencyResponse(*_moris.frequency_response(rig, parameters, strategy, force, rate, gravity_turns, platform))
