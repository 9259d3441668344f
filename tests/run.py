#!/usr/bin/env python3
"""Runs every test: the FMUs are built, Rust's tests run, then Python's in a virtual environment made for them; then the FMU
goes through other people's importers and, where there are Wine and qemu, through the libraries for other platforms; where
there is Chromium, the report's pages are opened in it.

    python3 tests/run.py [--install] [--require]

With --install what other platforms and the pages need is installed first; with --require it is an error where it is missing.
"""

import argparse
import os
import subprocess
import sys
import time
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
VENV = TARGET / "venv"
REQUIREMENTS = ROOT / "tests" / "python" / "requirements.txt"
PROGRAM = ".exe" if os.name == "nt" else ""


def run(*command):
    print("$", *command, flush=True)
    start = time.monotonic()
    subprocess.run([str(part) for part in command], cwd=ROOT, check=True)
    print(f"{time.monotonic() - start:.0f} s", flush=True)


def python():
    """The virtual environment's interpreter; the environment is made where it is missing or out of date."""
    interpreter = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    installed = VENV / "requirements.txt"
    if not installed.exists() or installed.read_text() != REQUIREMENTS.read_text():
        venv.create(VENV, with_pip=True, clear=True)
        run(interpreter, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", REQUIREMENTS)
        installed.write_text(REQUIREMENTS.read_text())
    return interpreter


def main():
    parser = argparse.ArgumentParser(description="Runs every test.")
    parser.add_argument("--require", action="store_true", help="what other platforms and the pages need must be there")
    parser.add_argument("--install", action="store_true", help="install it first, with apt, rustup and pip")
    arguments = parser.parse_args()
    passed_on = [f"--{name}" for name in ("install", "require") if getattr(arguments, name)]
    run("cargo", "build-fmu", "--fmi", "2,3")
    run("cargo", "build-fmu", "--fmi", "3", "--arrays")
    run("cargo", "build-ssp")
    run("cargo", "build-ssp", "--flat")
    run("cargo", "build-ssp", "--system", "MotorcycleLap")
    run("cargo", "build-ssp", "--system", "MotorcycleLap", "--flat")
    run("cargo", "test", "--workspace", "--", "--quiet")
    # These examples are compiled by now.
    for example in ("bound", "pages"):
        os.environ[f"MORIS_{example.upper()}"] = str(TARGET / "debug" / "examples" / (example + PROGRAM))
    run(python(), "-m", "pip", "install", "--verbose", "--disable-pip-version-check", ".")
    run(python(), "-m", "pytest", "--quiet", "tests/python")
    run(python(), "-m", "pytest", "--quiet", "tests/python_package")
    run(sys.executable, "tests/importers/run.py", *(["--require"] if arguments.require else []))
    run(sys.executable, "tests/platforms/run.py", *passed_on)
    run(sys.executable, "tests/report/run.py", *passed_on)
    print("No test has failed. What is missing above has not been run.")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:
        sys.exit(f"failed: {' '.join(map(str, error.cmd))}")
