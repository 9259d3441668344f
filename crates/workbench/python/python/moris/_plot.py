"""Pictures with matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import need

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._response import FrequencyResponse
    from ._simulation import Simulation

STANDARD_GRAVITY = 9.80665
FORCES = ("surge", "sway", "heave")
RATES = ("roll rate", "pitch rate", "yaw rate")


def _figure(figure: Any, size: tuple[float, float]) -> Any:
    return need("matplotlib.pyplot", "a plot").figure(figsize=size, layout="constrained") if figure is None else figure


def plot(simulation: Simulation, figure: Any = None) -> Any:
    """Felt over desired motion, channel by channel, the actuators' lengths, and when limits were active."""
    figure = _figure(figure, (11, 7))
    axes = figure.subplots(3, 3, sharex=True)
    force, rate = simulation.desired
    felt_force, felt_rate = simulation["rider.specificForce"], simulation["rider.angularVelocity"]
    rest = (0.0, 0.0, STANDARD_GRAVITY)
    for k in range(3):
        _channel(axes[0, k], simulation.time, force[:, k] - rest[k], felt_force[:, k] - rest[k], f"{FORCES[k]} [m/s²]")
        _channel(axes[1, k], simulation.time, np.degrees(rate[:, k]), np.degrees(felt_rate[:, k]), f"{RATES[k]} [°/s]")
    axes[0, 0].legend(loc="upper right", fontsize="small")
    _lines(axes[2, 0], simulation.time, simulation["actuator.length"], "actuators' lengths [m]")
    _lines(axes[2, 1], simulation.time, np.degrees(simulation["platform.orientation"]), "roll, pitch, yaw [°]")
    _limits(axes[2, 2], simulation)
    for axis in axes[2]:
        axis.set_xlabel("time [s]")
    figure.suptitle(simulation.name)
    return figure


def plot_felt(simulations: Sequence[Simulation], figure: Any = None) -> Any:
    """Felt surge and sway of each simulation over the desired one, a row for each recording."""
    recordings = list({id(one.recording): one.recording for one in simulations}.values())
    figure = _figure(figure, (11, 3.2 * len(recordings)))
    axes = figure.subplots(len(recordings), 2, squeeze=False)
    for row, recording in zip(axes, recordings):
        of_it = [one for one in simulations if one.recording is recording]
        for k, axis in enumerate(row):
            axis.plot(of_it[0].time, of_it[0].desired[0][:, k], color="0.6", linewidth=2.0, label="desired")
            for one in of_it:
                axis.plot(one.time, one["rider.specificForce"][:, k], linewidth=0.9, label=one.name)
            _frame(axis, f"{recording.name}: {FORCES[k]} [m/s²]")
        # Beside the curves, none of which it may hide.
        row[1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small")
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return figure


def _channel(axis: Any, time: NDArray[Any], desired: NDArray[Any], felt: NDArray[Any], title: str) -> None:
    axis.plot(time, desired, color="0.6", linewidth=1.2, label="desired")
    axis.plot(time, felt, color="C0", linewidth=1.0, label="felt")
    _frame(axis, title)


def _lines(axis: Any, time: NDArray[Any], values: NDArray[Any], title: str) -> None:
    axis.plot(time, values, linewidth=0.9)
    _frame(axis, title)


def _frame(axis: Any, title: str) -> None:
    axis.set_title(title, fontsize="medium")
    axis.grid(alpha=0.3)


def _limits(axis: Any, simulation: Simulation) -> None:
    flags = {"tilt": "status.tiltLimited", "safety units": "status.safetyActive", "actuator guard": "status.actuatorLimited"}
    for height, name in enumerate(flags.values()):
        active = simulation[name]
        axis.fill_between(simulation.time, height - 0.3, height + 0.3, where=active, color="C3", step="pre", linewidth=0)
    axis.set_yticks(range(3), list(flags), fontsize="small")
    axis.set_ylim(-0.6, 2.6)
    _frame(axis, "limits active")


def plot_response(response: FrequencyResponse, figure: Any = None) -> Any:
    """Modulus and phase of the direct channels over frequency, with the test's amplitudes and for small signals."""
    figure = _figure(figure, (11, 5))
    axes = figure.subplots(2, 6, sharex=True, sharey="row")
    for k, name in enumerate(response.channels):
        for ratios, style, label in ((response.small, "C1--", "small signals"), (response.ratios, "C0o-", "test")):
            direct = ratios[k, :, k]
            axes[0, k].loglog(response.frequencies, np.abs(direct), style, markersize=3, label=label)
            axes[1, k].semilogx(response.frequencies, np.degrees(np.angle(direct)), style, markersize=3)
        axes[0, k].set_title(name, fontsize="medium")
        axes[1, k].set_xlabel("rad/s")
        for axis in axes[:, k]:
            axis.grid(alpha=0.3)
    axes[0, 0].set_ylabel("modulus")
    axes[0, 0].set_ylim(1e-3, 3)
    axes[1, 0].set_ylabel("phase [°]")
    axes[0, 0].legend(fontsize="small")
    figure.suptitle("Felt over desired motion")
    return figure
