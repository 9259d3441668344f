#!/usr/bin/env python3
"""Builds the washout's FMUs of the present sources in another directory, and compares them with those of this one byte by byte.

    python3 tests/reproducible.py [--platform PLATFORMS]

The other directory has another length and a blank in its name, and a target directory of its own for the libraries. The exit
status is 1 if a file differs. Only files that git tracks are built.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FMUS = ["MorisWashout.fmu", "MorisWashout.fmi3.fmu"]


def build(sources, output, platforms):
    """Builds the FMUs of the sources. The tool is that of this directory: it takes the sources around the working directory."""
    command = ["cargo", "run", "--quiet", "--locked", "--target-dir", ROOT / "target", "--bin", "build-fmu", "--"]
    command += ["--model", "MorisWashout", "--fmi", "2,3", "--output", output, *platforms]
    subprocess.run(command, cwd=sources, check=True, stdout=subprocess.DEVNULL)


def copy_of_sources(directory):
    """What git tracks, as it is now."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in tracked.split("\0"):
        if name and (ROOT / name).is_file():
            (directory / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, directory / name)


def differences(first, second):
    """The files of two archives that differ; the archives' own bytes count as one more."""
    if first.read_bytes() == second.read_bytes():
        return []
    with zipfile.ZipFile(first) as one, zipfile.ZipFile(second) as other:
        names = sorted({*one.namelist(), *other.namelist()})
        read = lambda archive, name: archive.read(name) if name in archive.namelist() else None
        return [name for name in names if read(one, name) != read(other, name)] or ["the order or dates of the files"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--platform", help="platforms as of cargo build-fmu [default: this machine's]")
    chosen = parser.parse_args().platform
    platforms = ["--platform", chosen] if chosen else []
    failed = False
    with tempfile.TemporaryDirectory(prefix="another directory ") as folder:
        here, elsewhere, sources = Path(folder) / "here", Path(folder) / "elsewhere", Path(folder) / "sources of it"
        copy_of_sources(sources)
        build(ROOT, here, platforms)
        build(sources, elsewhere, platforms)
        for name in FMUS:
            found = differences(here / name, elsewhere / name)
            print(f"{name}: {'differs in ' + ', '.join(found) if found else 'the same bytes'}")
            failed |= bool(found)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
