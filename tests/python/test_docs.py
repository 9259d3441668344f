"""Runs the code blocks of README.md and docs/ as they are printed, and compares the output that the pages show.

A page's blocks run in order, in a directory of the page's own that looks like the repository. The word after a block's
opening fence is its language:

    ```sh                   commands, run by bash
    ```sh skip: REASON      commands that cannot run here; packages, tests and files that they name must exist
    ```python               a script
    ```rust                 a doc test: a crate includes the page
    ```toml FILE            a file that a later command of the page reads (also csv)
    ```text output          the standard output of the block before
    ```text                 neither

    target/venv/bin/python tests/python/test_docs.py --update [PAGE ...]

runs the pages and replaces the output that they show. The FMUs of target/fmu stay as they are: each page has its own.
"""

import json
import os
import platform
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest
from conftest import ROOT, TARGET, only_all_cases
from repository import source_files

EXAMPLES = ROOT / "examples" / "README.md"
PAGES = [EXAMPLES, ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
# Its scripts are one script in parts, which tests/python_package/test_docs.py runs.
PYTHON_PAGE = ROOT / "docs" / "python.md"
FENCE = re.compile(r"^```(?P<language>\w*) ?(?P<information>[^\n]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
FILES = ("toml", "csv")
# The command that runs these tests.
ALL_TESTS = "python3 tests/run.py"
# By page: pictures of docs/, and the files in target/ that commands of the page draw.
DRAWN = {
    "README.md": {"first-ride.svg": "first-ride/ride.svg"},
    "docs/strategies.md": {"strategies.svg": "paper-runs/strategies.svg"},
    "docs/response.md": {"response.svg": "docs/docs-response/response/direct.svg"},
}
SEARCHES = ("docs/response.md", "docs/tuning-by-search.md", "docs/worst-case.md")
"""Pages whose commands simulate hundreds of rides. The tests in Rust run the same commands in a short form."""
PICTURES_OF_SEARCHES = ("05_tune.svg",)
"""The last bit of a simulation may lead a search elsewhere: of its picture, the words are compared, not the curves."""
FMUS = "target/fmu"
COPIED = ("docs", "examples", FMUS)
LINKED = ("benches", "build-fmu", "crates", "fuzz", "modelDescription", "presets", "src", "tests")


@dataclass
class Block:
    page: Path
    line: int
    language: str
    information: str
    text: str

    def __str__(self):
        return f"{name(self.page)}:{self.line}"


def name(page):
    return page.relative_to(ROOT).as_posix()


def blocks(page):
    """The fenced blocks of a page, in order."""
    text = page.read_text()
    for match in FENCE.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        yield Block(page, line, match["language"], match["information"], match["text"])


def page_directory(page):
    """Never within another page's: pages run at the same time."""
    return TARGET / "docs" / name(page).removesuffix(".md").replace("/", "-")


def scratch_directory(page):
    """A directory for the page's commands: links to the repository's directories, copies of those that they write to."""
    directory = page_directory(page)
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    for entry in COPIED:
        shutil.copytree(TARGET / "fmu" if entry == FMUS else ROOT / entry, directory / entry)
    for entry in LINKED:
        (directory / entry).symlink_to(ROOT / entry)
    return directory


def run(block, directory):
    """Runs the block in the directory and returns its standard output."""
    environment = os.environ | {
        "MPLBACKEND": "Agg",
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        "MORIS_FMUS": str(directory / "target" / "fmu"),
    }
    text = "\n".join(line for line in block.text.splitlines() if not line.startswith(ALL_TESTS))
    command = ["bash", "-euo", "pipefail", "-c", text] if block.language == "sh" else [sys.executable, "-c", text]
    done = subprocess.run(command, cwd=directory, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, f"{block} ends with {done.returncode}:\n{text}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def run_page(page):
    """Runs the page's blocks and returns those that show output, each with the output that there was."""
    directory, output, shown = scratch_directory(page), None, []
    for block in blocks(page):
        if block.language in FILES:
            (directory / block.information).write_text(block.text)
        elif block.language in ("sh", "python") and not block.information:
            output = run(block, directory)
        elif block.information == "output":
            shown.append((block, plain(output, directory)))
    return shown


def plain(output, directory=ROOT):
    """Output without spaces at line ends, empty lines around it and paths of this machine."""
    lines = output.replace(f"{directory}/", "").replace(f"{ROOT}/", "").splitlines()
    return "\n".join(line.rstrip() for line in lines).strip("\n") + "\n"


def pictures(page):
    """Pictures that a page's commands draw: each as it is in the repository, and as it has been drawn."""
    if page == EXAMPLES:
        drawn = page_directory(EXAMPLES) / "target" / "examples"
        return [(file, drawn / file.name) for file in sorted(EXAMPLES.parent.glob("*.svg"))]
    return [(ROOT / "docs" / shown, TARGET / drawn) for shown, drawn in DRAWN.get(name(page), {}).items()]


def assert_same_picture(expected, drawn):
    """The same words at all times, and the same curves if the same version of the plotting library has drawn them."""
    texts = [re.findall(r"<text[^>]*>([^<]*)", file.read_text()) for file in (expected, drawn)]
    if expected.name in PICTURES_OF_SEARCHES:
        words = [[text for text in found if re.search("[a-z]", text)] for found in texts]
        assert len(words[0]) > 5 and words[0] == words[1], f"{name(expected)} is stale"
        return
    assert texts[0] == texts[1], f"{name(expected)} is stale: run tests/python/test_docs.py --update"
    versions = [re.findall(r"Matplotlib v[\d.]+", file.read_text()) for file in (expected, drawn)]
    if versions[0] == versions[1]:
        curves = [re.findall(r' (?:d|points)="([^"]*)"', file.read_text()) for file in (expected, drawn)]
        numbers = [[float(n) for n in re.findall(r"-?\d+\.?\d*", " ".join(curve))] for curve in curves]
        assert len(numbers[0]) == len(numbers[1]) > 100, name(expected)
        assert max(abs(a - b) for a, b in zip(*numbers)) < 1.0, f"{name(expected)} is stale"


def with_commands(page):
    """True if these tests run blocks of the page."""
    return page != PYTHON_PAGE and any(
        block.language in ("sh", "python") and not block.information for block in blocks(page)
    )


def case(page):
    return pytest.param(page, id=name(page), marks=[only_all_cases] if name(page) in SEARCHES else [])


@pytest.mark.skipif(os.name == "nt", reason="needs bash: run the tests on Linux or macOS")
@pytest.mark.skipif(ROOT not in TARGET.parents, reason="needs target/ within the sources, where cargo finds them: unset CARGO_TARGET_DIR")
@pytest.mark.parametrize("page", [case(page) for page in PAGES if with_commands(page)])
def test_the_commands_of_a_page_run_and_print_what_it_shows(page):
    shown = run_page(page)
    # Elsewhere the last digits of a search may differ.
    if sys.platform == "linux" and platform.machine() == "x86_64":
        for block, output in shown:
            assert output == plain(block.text), f"{block} is stale: run tests/python/test_docs.py --update"
    for expected, drawn in pictures(page):
        assert_same_picture(expected, drawn)


@cache
def pages_with_doc_tests():
    """The pages, by their names, that a crate includes."""
    sources = [file.read_text() for file in source_files() if file.suffix == ".rs"]
    return {page for text in sources for page in re.findall(r'include_str!\("[./]*([^"]*\.md)"\)', text)}


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_every_block_is_of_a_kind_that_is_checked(page):
    before = None
    for block in blocks(page):
        language, information = block.language, block.information
        if language == "sh":
            assert not information or information.startswith("skip: "), f"{block}: {information}"
        elif language in FILES:
            used = any(other.language == "sh" and information in other.text for other in blocks(page))
            assert information and used, f"{block}: no command of the page reads this file"
        elif language == "rust":
            assert name(page) in pages_with_doc_tests(), f"{block}: no crate includes the page as a doc test"
        elif language == "text" and information:
            assert information == "output" and before in ("sh", "python"), f"{block}: of which command?"
        else:
            assert language in ("python", "text") and not information, f"{block}: {language} {information}"
        before = language
    indented = re.search(r"\n\n    (cargo|python|pip|cmake|apt) .*", FENCE.sub("", page.read_text()))
    assert not indented, f"{name(page)}: a command outside of a fence: {indented[0].strip()}"


def anchors(page):
    """The anchors of a page's headings."""
    headings = re.findall(r"^#+ (.*)$", FENCE.sub("", page.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", [*PAGES, ROOT / "ARCHITECTURE.md", ROOT / "DESIGN.md", ROOT / "SECURITY.md"], ids=name)
def test_every_link_within_the_repository_leads_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", FENCE.sub("", page.read_text())):
        if ":" in target or "releases" in target:
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), f"{name(page)}: {target}"
        assert not anchor or anchor in anchors(file), f"{name(page)}: {target}"


def skipped_commands():
    return [block for page in PAGES for block in blocks(page) if block.information.startswith("skip: ")]


@cache
def targets():
    """The packages of the workspace, and their benches and examples, by kind."""
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    packages = json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout)["packages"]
    found = {"package": {package["name"] for package in packages}}
    for kind in ("bench", "example"):
        found[kind] = {t["name"] for package in packages for t in package["targets"] if kind in t["kind"]}
    return found


@pytest.mark.parametrize("block", skipped_commands(), ids=str)
def test_a_command_that_is_not_run_names_what_there_is(block):
    for option, value in re.findall(r"(-p|--package|--bench|--example) (\S+)", block.text):
        kind = {"-p": "package", "--package": "package", "--bench": "bench", "--example": "example"}[option]
        assert value in targets()[kind], f"{block}: {option} {value}"
    for file in re.findall(r"python3 (\S+\.py)", block.text):
        assert (ROOT / file).exists(), f"{block}: {file}"


def update(page):
    """Replaces the output that the page shows, and the pictures."""
    text = page.read_text()
    for block, output in run_page(page):
        # A page may show the same output twice, or nothing yet.
        head, rest = text.split(f"```text output\n{block.text}```", 1)
        text = f"{head}```text output\n{output}```{rest}"
    page.write_text(text)
    for expected, drawn in pictures(page):
        shutil.copy(drawn, expected)


if __name__ == "__main__":
    assert sys.argv[1:2] == ["--update"], __doc__
    for page in [Path(argument).resolve() for argument in sys.argv[2:]] or filter(with_commands, PAGES):
        print(name(page), flush=True)
        update(page)
