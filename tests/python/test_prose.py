"""The rules of the repository's prose, which tests/prose.py measures."""

import subprocess
import sys

from conftest import ROOT


def test_the_prose_keeps_its_rules():
    done = subprocess.run([sys.executable, "tests/prose.py", "--check", "--list"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
