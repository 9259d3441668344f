"""Compares the figures that sentences of the pages quote with the places that they come from.

Tables that are generated and blocks of output are checked where they are made.
"""

import re

import pytest
from conftest import ROOT
from test_docs import FENCE

FIGURE = r"\d[\d,]*(?:\.\d+)?"
QUOTED = re.compile(r"\d[\d,]*(?:\.\d+)?(?=\s(?:m/s²|m/s³|rad/s|µs|ns|ms|s|%|MB|kB|minutes)(?!\w))|\d+\.\d+")
"""A figure that needs a source: it has a unit or a fraction."""

BOARD, PERFORMANCE, WORST_CASE = "docs/board.md", "docs/performance.md", "docs/worst-case.md"
VERDICT, FINDINGS = (f"crates/workbench/simulation/src/{name}.rs" for name in ("verdict", "findings"))
COORDINATED, TILT = (f"src/cueing/strategy/{name}.rs" for name in ("coordinated", "smooth_tilt"))
HORIZON = "src/cueing/strategy/predictive/horizon.rs"
GRAVITY = ("src/interface.rs", "STANDARD_GRAVITY: f64 = #")
CLAIMS = [
    # A page, words with # for a figure (~ for another one), and for this figure a file, words there, and what its figure is multiplied by.
    ("README.md", "rustup.rs) # or newer", "Cargo.toml", 'rust-version = "#"'),
    ("README.md", "Python # or newer", "tests/environments.py", "Python # or newer is needed"),
    ("README.md", "glibc # and newer", "build-fmu/src/compile.rs", 'OLDEST_GLIBC: &str = "#"'),
    ("README.md", "less than # µs a step", PERFORMANCE, "exchange with the washout, classical strategy | # ns", 0.001),
    ("README.md", ", # µs with `predictive`", PERFORMANCE, "a part of its next plan included | #,"),
    ("README.md", "surge and sway: # m/s² with `classical`", WORST_CASE, "| `classical` | #,"),
    ("README.md", ", # with `predictive`", WORST_CASE, "| `predictive` | #,"),
    ("README.md", ", # with a preview", "docs/strategies.md", "are ~ and ~, and #"),
    ("README.md", "a preview of # s", "docs/strategies.md", "and a preview of # s"),
    ("README.md", "`classical` has #", WORST_CASE, "| `classical` | ~, #,"),
    ("README.md", "and `predictive` #.", WORST_CASE, "| `predictive` | ~, #,"),
    ("docs/guide.md", "(0, 0, #)", *GRAVITY),
    ("docs/guide.md", "is not # at rest", *GRAVITY),
    ("docs/guide.md", "add # to z", *GRAVITY),
    ("docs/guide.md", "and `.y` at # or less", "docs/parameter-sets.md", "| `scale.angularVelocity.y` | | # |"),
    ("docs/strategies.md", "a plan of the next # s", HORIZON, "FORECAST_TIME: f64 = #;"),
    ("docs/strategies.md", "critically damped at # rad/s", COORDINATED, "RETURN_FREQUENCY: f64 = #;"),
    ("docs/strategies.md", "and the tilt at # rad/s", COORDINATED, "LEVEL_FREQUENCY: f64 = #;"),
    ("docs/strategies.md", "(# rad/s³)/A", TILT, "ALLOWED_JERK: f64 = #;"),
    ("docs/strategies.md", "at least # 1/s", TILT, "LEAST_BUILD_UP: f64 = #;"),
    ("docs/strategies.md", "c/3, # rad/s", TILT, "LARGEST_PACE: f64 = #;"),
    ("docs/strategies.md", "and # A/W", TILT, "PACE_OF_LIMITS: f64 = #;"),
    ("docs/strategies.md", "each error is at least #", WORST_CASE, "each error at least # m/s²"),
    ("docs/strategies.md", "are ~ and #,", WORST_CASE, "| `predictive` | #,"),
    ("docs/strategies.md", "and a preview of # s", "docs/strategies/predictive.md", "--parameters preview --preview #"),
    ("docs/strategies/predictive.md", "RMS errors is # m/s²", "docs/strategies.md", "of 19 channels | | | | ~ | ~ | ~ | ~ | # |"),
    ("docs/scale.md", "at most # % of inverted time", FINDINGS, "MAX_INVERTED_FRACTION: f64 = #;", 100),
    ("docs/scale.md", "| # % of the time |", FINDINGS, "MAX_INVERTED_FRACTION: f64 = #;", 100),
    ("docs/scale.md", "| # m/s², ~ m/s² |", VERDICT, "MAX_SMOOTH_JOLT: f64 = #;"),
    ("docs/scale.md", "| ~ m/s², # m/s² |", VERDICT, "MAX_SMOOTH_SHAKE: f64 = #;"),
    ("docs/scale.md", "| # % of what is desired", FINDINGS, "WORSE_THAN_REST: f64 = #;", 100),
    ("docs/scale.md", "what is desired; # % of the time", FINDINGS, "FALSE_CUES: f64 = #;", 100),
    ("docs/scale.md", "| below # |", FINDINGS, "RIGHT_SHAPE: f64 = #;"),
    ("docs/live.md", "is silent for # ms", "crates/live/command/src/controls.rs", "CONTROLS_TIMEOUT: Duration = Duration::from_millis(#)"),
    ("docs/laps.md", "Below # m/s", "crates/live/laps/src/laps.rs", "LEAST_SPEED: f64 = #;"),
    (PERFORMANCE, "predictive | mean #,", BOARD, "| `classical` | # |"),
    (PERFORMANCE, "predictive | mean ~, # instructions", BOARD, "| `predictive` | # |"),
    (PERFORMANCE, "~ instructions; at most #, ~ |", BOARD, "| `classical` | ~ | # |"),
    (PERFORMANCE, "at most ~, # |", BOARD, "| `predictive` | ~ | # |"),
]
COMPLETE = {
    # Pages of which each figure has a claim, with words around those that need none, and why.
    "README.md": ["FMI 2.0 and 3.0", "for FMI 3.0", "Apache-2.0"],  # names
    # Advice that the page's examples do not depend on.
    "docs/guide.md": ["`input.cutoff` = 12 rad/s"],
    # Measured on recordings that are not in the repository.
    "docs/strategies.md": ["the means are ~ and", "and ~, and ~ with"],
}


def expression(words):
    """Words as an expression: # is the figure, ~ another one, and between words is any space or line break."""
    escaped = r"\s+".join(re.escape(word) for word in words.split())
    return re.compile(escaped.replace(r"\#", f"({FIGURE})").replace(r"\~", FIGURE).replace("~", FIGURE))


def prose(page):
    """A page without its blocks."""
    return FENCE.sub("", (ROOT / page).read_text())


def number(text):
    return float(text.replace(",", ""))


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: f"{claim[0]}: {claim[1]}")
def test_a_quoted_figure_is_that_of_its_source(claim):
    page, words, source, place, *factor = claim
    quoted = expression(words).findall(prose(page))
    assert quoted, f"{page} has no such words: change this row with them"
    found = expression(place).search((ROOT / source).read_text())
    assert found, f"{source} has no such words: {place}"
    value = number(found[1]) * (factor or [1])[0]
    for figure in quoted:
        decimals = len(figure.partition(".")[2])
        same = abs(number(figure) - value) <= 0.5 * 10**-decimals + 1e-9 or figure == found[1]
        below = words.startswith("less than") and value < number(figure)
        assert same or below, f"{page} quotes {figure}, {source} has {value:g}: {words}"


@pytest.mark.parametrize("page", COMPLETE)
def test_each_figure_of_a_page_has_a_source(page):
    # Of measured tables only the page's own sentences are quotations.
    text = re.sub(r"^\| .*\d\.\d{2,3} \|$", lambda row: " " * len(row[0]), prose(page), flags=re.MULTILINE)
    text = re.sub(r"\]\([^)]*\)", lambda link: " " * len(link[0]), text)
    words = [claim[1] for claim in CLAIMS if claim[0] == page] + COMPLETE[page]
    covered = [match.span() for one in words for match in expression(one).finditer(prose(page))]
    for figure in QUOTED.finditer(text):
        line = text.count("\n", 0, figure.start()) + 1
        is_covered = any(start <= figure.start() and figure.end() <= end for start, end in covered)
        assert is_covered, f"{page}: where does {figure[0]} come from? {text.splitlines()[line - 1]}"
