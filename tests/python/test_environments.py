"""The table of environments in which README's commands are tried: its use in the workflow, and what is refused in one line."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT
from environments import ENVIRONMENTS, readme_commands

# Nothing is compiled in these.
REFUSED = [name for name, environment in ENVIRONMENTS.items() if set(environment.refused) == set(range(len(environment.commands)))]


def test_the_commands_are_those_of_readme():
    assert readme_commands() == ["cargo first-ride", "python3 tests/run.py"]


def test_the_workflow_runs_every_environment():
    workflow = (ROOT / ".github" / "workflows" / "ci.yml").read_text()
    matrix = re.search(r"^  environments:\n.*?^    runs-on", workflow, re.MULTILINE | re.DOTALL)[0]
    assert re.findall(r"^ {10}- (\S+)$", matrix, re.MULTILINE) == list(ENVIRONMENTS)


@pytest.mark.skipif(sys.platform != "linux", reason="needs Linux: the environments are made there")
@pytest.mark.skipif(not (ROOT / ".git").exists() or not shutil.which("git"), reason="needs git and a clone: environments are clones")
@pytest.mark.parametrize("name", ["no-ensurepip", "no-cargo"])
def test_what_the_tests_cannot_do_without_is_refused_in_one_line(name, tmp_path):
    assert name in REFUSED
    command = [sys.executable, ROOT / "tests" / "environments.py", "--only", name, "--work", tmp_path, "--require"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and "refused: " in done.stdout, done.stdout + done.stderr


def test_an_archive_has_the_files_that_git_tracks():
    """The fallback without git takes the same files, but for those not yet added."""
    from repository import git_files, unpacked_files

    tracked = git_files()
    if not tracked:
        pytest.skip("needs git and a clone: git clone")
    assert not set(tracked) - set(unpacked_files())
