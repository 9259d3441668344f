"""Output of the scripts beside this one: a line of JSON for each thing that they ran.

A line belongs to a column of the table in docs/importers.md: `2.0` or `3.0`, a ride with an FMU of that version, or `SSP`.
"""

import json

from ride import EXACT, TOLERANCE


def difference(what, largest, column="2.0"):
    """Something was run, and this is the largest difference from the reference."""
    verdict = "ok" if largest <= (EXACT if what.startswith(("Motorcycle", "StewartPlatform")) else TOLERANCE) else "FAILED"
    _line(what, f"{largest:.1e}", verdict, column)


def ride(ride, how, largest):
    """The reference ride of an FMU was made, in this manner."""
    difference(f"{ride.model}, FMI {ride.fmi}: ride{how}", largest, ride.fmi)


def check(what, passed, reason="", column="2.0"):
    """Something was looked at that has no numbers to compare."""
    _line(what, "-", "ok" if passed else f"FAILED ({reason})" if reason else "FAILED", column)


def _line(what, largest, verdict, column):
    print(json.dumps({"what": what, "difference": largest, "verdict": verdict, "column": column}), flush=True)
