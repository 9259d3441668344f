"""The survey of a rig."""

from __future__ import annotations

from typing import Any, NamedTuple

from . import _moris
from ._types import Rig


class AxisReach(NamedTuple):
    """Reach, speed and acceleration of a platform along one axis alone, from neutral."""

    min: float
    """[m] or [rad]"""
    max: float
    """[m] or [rad]"""
    speed: float | None
    """[m/s] or [rad/s]; None where the legs do not limit it: the platform is singular at neutral"""
    acceleration: float | None
    """[m/s2] or [rad/s2]; None as the speed"""


class Survey:
    """Reach, workspace and singularities of a rig.

    name: of the rig. reach: dict from axis (surge, sway, heave, roll, pitch, yaw) to AxisReach.
    volume: of the workspace with the platform level [m3]. tilted_volume: where it can be tilted by 10 degrees, too [m3].
    smallest_singular_value, worst_condition: of the Jacobian over all leg lengths; None for a singular rig.
    singular_at: leg lengths at a singularity, (6,) [m]; None for a rig that can be used.
    closest_legs: numbers of the two legs that come closest to each other. leg_clearance: their distance there [m].
    """

    name: str
    reach: dict[str, AxisReach]
    volume: float
    tilted_volume: float
    smallest_singular_value: float | None
    worst_condition: float | None
    singular_at: list[float] | None
    closest_legs: tuple[int, int]
    leg_clearance: float

    def __init__(self, name: str, axes: Any, volumes: Any, condition: Any, singular_at: Any, closest: Any, text: str, picture: str) -> None:
        self.name = name
        self.reach = {axis: AxisReach(*reach) for axis, *reach in axes}
        (self.volume, _), (self.tilted_volume, _) = volumes
        self.smallest_singular_value, self.worst_condition = condition or (None, None)
        self.singular_at = singular_at
        closest_legs, self.leg_clearance = closest
        self.closest_legs = (closest_legs[0], closest_legs[1])
        self._text = text
        self._picture = picture

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"Survey({self.name!r}, {'singular' if self.singular_at else 'free of singularities'})"

    def _repr_svg_(self) -> str:
        return self._picture


def survey(rig: Rig | None = None, samples: int = 1_000_000) -> Survey:
    """Surveys a rig: reach along each axis alone, workspace, and singularities inside the stroke of its legs.

    rig: as for Washout. samples: points that are tried for the volumes. Returns a Survey.
    """
    if not 1000 <= samples <= 1_000_000_000:
        raise ValueError(f"samples is {samples}, but must be from 1000 to 1e9")
    return Survey(*_moris.survey(rig, int(samples)))
