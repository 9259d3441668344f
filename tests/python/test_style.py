"""Python's lints, with the rules of pyproject.toml; and names in Rust."""

import re
import subprocess
import sys

import pytest
from conftest import ROOT
from repository import source_files

ONE_WORD_CONSTANTS = {
    "a size of the plan's program": "BLOCKS CONTROLS CORNERS DATA EXPERTS FEATURES FORCES ROWS TARGETS",
    "a preset of that name": "ADAPTIVE CLASSICAL OPTIMAL PAPER PREVIEW ROBUST",
    "the one step of its file": "STEP TICK",
    "the item, list or horizon that its file is about": "AXES COMPONENTS IDENTITY MOTORCYCLE PLATFORM PRIOR SYSTEMS WASHOUT",
    "a word of its standard or source": "CANALS G KVC OTOLITHS TERMINATED WF",
    "of the package": "AUTHOR COPYRIGHT LICENSE",
    "the tolerance of its file": "ROUNDING",
}
"""Constants of modules that may have a name of one word, by the reason."""
MAX_ONE_WORD_FUNCTIONS = 0.35
"""Fraction of the free functions: what is a verb of the field, such as `step`, needs no second word."""


def test_ruff_finds_nothing():
    done = subprocess.run([sys.executable, "-m", "ruff", "check", "--output-format", "concise", ROOT], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def rust():
    """The product's sources in Rust, without the tests in them."""
    files = [file for file in source_files() if file.suffix == ".rs" and file.name != "tests.rs"]
    paths = [file for file in files if not {"benches", "fuzz", "tests"} & set(file.relative_to(ROOT).parts)]
    assert len(paths) > 200
    return "\n".join(path.read_text(encoding="utf-8").partition("#[cfg(test)]\nmod tests {")[0] for path in paths)


def test_a_constant_says_in_more_than_one_word_of_what_it_is(rust):
    found = set(re.findall(r"^(?:pub(?:\([a-z]+\))? )?const ([A-Z][A-Z0-9]*): ", rust, re.MULTILINE))
    assert found == set(" ".join(ONE_WORD_CONSTANTS.values()).split())


def test_few_free_functions_have_a_name_of_one_word(rust):
    found = re.findall(r"^(?:pub(?:\([a-z]+\))? )?(?:const )?fn ([a-z]\w*)", rust, re.MULTILINE)
    short = [name for name in found if "_" not in name]
    assert len(found) > 1000 and len(short) <= MAX_ONE_WORD_FUNCTIONS * len(found), f"{len(short)} of {len(found)}"


def test_no_text_names_a_constant(rust):
    """A renamed constant renames no sentence. Placeholders such as `{NAME}` and `{:.NAME$}` are none of the text."""
    constants = set(re.findall(r"\b(?:const|static) ([A-Z][A-Z0-9]*_[A-Z0-9_]+):", rust))
    texts = re.findall(r'"(?:[^"\\\n]|\\.|\\\n)*"', rust)
    words = {word for text in texts for word in re.findall(r"(?<![{.\w])[A-Z]\w+\b(?!\$)", text)}
    assert len(constants) > 300 and not words & constants
