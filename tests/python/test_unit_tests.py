"""Libraries and programs without unit tests are not compiled for them; none that has some may be among these."""

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def targets_without_unit_tests():
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    packages = json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout)["packages"]
    for target in (target for package in packages for target in package["targets"]):
        if target["kind"][0] in ("lib", "cdylib", "bin") and not target["test"]:
            yield target


def sources(target):
    """The target's files: for a program beside a library its own file only."""
    root = Path(target["src_path"])
    return [root] if target["kind"] == ["bin"] else root.parent.rglob("*.rs")


def test_what_is_not_compiled_for_unit_tests_has_none():
    targets = list(targets_without_unit_tests())
    assert targets
    for file in (file for target in targets for file in sources(target)):
        assert "#[test]" not in file.read_text(), f"{file}: remove `test = false` from the manifest"
