"""The survey of a rig."""

from typing import NamedTuple, Optional

from . import _moris


class AxisReach(NamedTuple):
    """Reach, speed and acceleration of a platform along one axis alone, from neutral."""

    min: float
    """[m] or [rad]"""
    max: float
    """[m] or [rad]"""
    speed: Optional[float]
    """[m/s] or [rad/s]; None where the legs do not limit it: the platform is singular at neutral"""
    acceleration: Optional[float]
    """[m/s2] or [rad/s2]; None as the speed"""


class Survey:
    """Reach, workspace and singularities of a rig.

    name: of the rig. reach: dict from axis (surge, sway, heave, roll, pitch, yaw) to AxisReach.
    volume: of the workspace with the platform level [m3]. tilted_volume: where it can be tilted by 10 degrees, too [m3].
    smallest_singular_value, worst_condition: of the Jacobian over all leg lengths; None for a singular rig.
    singular_at: leg lengths at a singularity, (6,) [m]; None for a rig that can be used.
    closest_legs: numbers of the two legs that come closest to each other. leg_clearance: their distance there [m].
    """

    def __init__(self, name, axes, volumes, condition, singular_at, closest, text, picture):
        self.name = name
        self.reach = {axis: AxisReach(*reach) for axis, *reach in axes}
        (self.volume, _), (self.tilted_volume, _) = volumes
        self.smallest_singular_value, self.worst_condition = condition or (None, None)
        self.singular_at = singular_at
        closest_legs, self.leg_clearance = closest
        self.closest_legs = tuple(closest_legs)
        self._text = text
        self._picture = picture

    def __str__(self):
        return self._text

    def __repr__(self):
        return f"Survey({self.name!r}, {'singular' if self.singular_at else 'free of singularities'})"

    def _repr_svg_(self):
        return self._picture


def survey(rig=None, samples=1_000_000):
    """Surveys a rig: reach along each axis alone, workspace, and singularities inside the stroke of its legs.

    rig: as for Washout. samples: points that are tried for the volumes. Returns a Survey.
    """
    if not 1000 <= samples <= 1_000_000_000:
        raise ValueError(f"samples is {samples}, but must be from 1000 to 1e9")
    return Survey(*_moris.survey(rig, int(samples)))
