"""How the scripts beside this one say what they found: a line of JSON for each thing that they ran."""

import json

from ride import TOLERANCE


def difference(what, largest):
    """Something was run, and this is the largest difference from the reference."""
    verdict = "ok" if largest <= TOLERANCE else "FAILED"
    _line(what, f"{largest:.1e}", verdict)


def check(what, passed, reason=""):
    """Something was looked at that has no numbers to compare."""
    _line(what, "-", "ok" if passed else f"FAILED ({reason})" if reason else "FAILED")


def _line(what, largest, verdict):
    print(json.dumps({"what": what, "difference": largest, "verdict": verdict}), flush=True)
