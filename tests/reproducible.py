#!/usr/bin/env python3
"""Builds the washout's FMUs, or the command moris, in another directory, and compares the files with those of this one byte by byte.

    python3 tests/reproducible.py [--platform PLATFORMS] [--model MODEL]
    python3 tests/reproducible.py --program PROFILE

The platforms are those given, else this machine's and, where its tools are installed, Windows.
The other directory has another length and a blank in its name, and a target directory of its own for the libraries. The exit
status is 1 if a file differs. Files that .gitignore names are not taken. With --program the other directory compiles all
dependencies again, which takes some six minutes of two cores, so that tests/run.py leaves it out.
"""

import argparse
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from repository import ROOT, source_files

WINDOWS = "x86_64-pc-windows-gnu"


def default_platforms():
    """This machine's, and Windows if it can be compiled for; on Linux on x86-64 only."""
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        return []
    sysroot = subprocess.run(["rustc", "--print", "sysroot"], check=True, capture_output=True, text=True).stdout.strip()
    has_windows = shutil.which("x86_64-w64-mingw32-gcc") and Path(sysroot, "lib", "rustlib", WINDOWS).is_dir()
    print("win64: " + ("compiled, too" if has_windows else "missing (GCC for Windows, or Rust's standard library for it)"))
    return ["--platform", "linux64,win64"] if has_windows else []


def build(sources, output, model, platforms):
    """Builds the FMUs of the sources. The tool is that of this directory: it takes the sources around the working directory."""
    command = ["cargo", "run", "--quiet", "--locked", "--target-dir", ROOT / "target", "--bin", "build-fmu", "--"]
    command += ["--model", model, "--fmi", "2,3", "--output", output, *platforms]
    subprocess.run(command, cwd=sources, check=True, stdout=subprocess.DEVNULL)


def copy_of_sources(directory):
    """The files of the sources, as they are now."""
    for file in source_files():
        copy = directory / file.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(file, copy)


def differences(first, second):
    """The files of two archives that differ; the archives' own bytes count as one more."""
    if first.read_bytes() == second.read_bytes():
        return []
    with zipfile.ZipFile(first) as one, zipfile.ZipFile(second) as other:
        names = sorted({*one.namelist(), *other.namelist()})
        read = lambda archive, name: archive.read(name) if name in archive.namelist() else None
        return [name for name in names if read(one, name) != read(other, name)] or ["the order or dates of the files"]


def program(profile):
    """The command of each directory, as .ci/release.py makes it; true if they are equal."""
    sys.path.insert(0, str(ROOT / ".ci"))
    from release import PROGRAM, without_paths

    made = []
    with tempfile.TemporaryDirectory(prefix="another directory ") as folder:
        sources = Path(folder) / "sources of it"
        # The version of the command has the commit.
        subprocess.run(["git", "clone", "--quiet", "--no-checkout", ROOT, sources], check=True)
        copy_of_sources(sources)
        for root in (ROOT, sources):
            command = ["cargo", "build", "--quiet", "--locked", "--package", "moris", "--profile", profile]
            subprocess.run([*command, "--target-dir", root / "target"], cwd=root, check=True, env=without_paths(root))
            directory = root / "target" / ("debug" if profile == "dev" else profile)
            made.append((directory / f"moris{PROGRAM}").read_bytes())
    print(f"moris{PROGRAM}: {'the same bytes' if made[0] == made[1] else 'differs'} ({len(made[0])} bytes)")
    return made[0] == made[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--platform", help="platforms as of cargo build-fmu")
    parser.add_argument("--model", default="MorisWashout", help="[default: MorisWashout]")
    parser.add_argument("--program", metavar="PROFILE", help="the command moris of this profile in place of FMUs")
    options = parser.parse_args()
    if options.program:
        sys.exit(0 if program(options.program) else 1)
    platforms = ["--platform", options.platform] if options.platform else default_platforms()
    failed = False
    with tempfile.TemporaryDirectory(prefix="another directory ") as folder:
        here, elsewhere, sources = Path(folder) / "here", Path(folder) / "elsewhere", Path(folder) / "sources of it"
        copy_of_sources(sources)
        build(ROOT, here, options.model, platforms)
        build(sources, elsewhere, options.model, platforms)
        for name in (f"{options.model}.fmu", f"{options.model}.fmi3.fmu"):
            found = differences(here / name, elsewhere / name)
            print(f"{name}: {'differs in ' + ', '.join(found) if found else 'the same bytes'}")
            failed |= bool(found)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
