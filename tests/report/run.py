#!/usr/bin/env python3
"""Opens the report's pages in Chromium and Firefox without a window, and holds what they show against the data they were made of.

    python3 tests/report/run.py [--require] [--install]

The pages are those of crates/workbench/pages/tests/programs/pages.rs, one of `moris simulate`, and those of `moris ride` and
`moris live`. In Firefox the most important checks are run. Without a browser or Playwright its checks are not run, and that is
said; with --require it is an error. With --install all are installed first (apt and pip; for Debian). Pictures are left in
target/report/.
"""

import argparse
import csv
import math
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "tests"))
from installing import install_packages  # noqa: E402

WORK = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "report"
VENV = WORK / "venv"
PYTHON = VENV / "bin" / "python"

# Packages, and the commands that they bring.
BROWSERS = {"chromium": ["chromium", "chromium-browser", "google-chrome"], "firefox-esr": ["firefox-esr", "firefox"]}
# Later ones send commands that Firefox 153 does not know.
PIP = ["playwright==1.60.0"]


def check_call(*command):
    print("$", *command, flush=True)
    subprocess.run([str(part) for part in command], cwd=ROOT, check=True)


def install():
    missing = [package for package in BROWSERS if not browser(package)]
    if missing:
        install_packages(*missing)
    if not PYTHON.exists():
        venv.create(VENV, with_pip=True)
    check_call(PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PIP)


def browser(package="chromium"):
    return next(filter(None, map(shutil.which, BROWSERS[package])), None)


def playwright():
    """An interpreter that has Playwright."""
    for interpreter in (PYTHON, Path(sys.executable)):
        found = interpreter.exists() and subprocess.run([interpreter, "-c", "import playwright"], capture_output=True)
        if found and found.returncode == 0:
            return interpreter
    return None


def write_ride(file):
    """20 s at 100 Hz: pull away, bends, a stop."""
    with open(file, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["time", "ax", "ay", "az", "wx", "wy", "wz"])
        for k in range(2001):
            t = 0.01 * k
            bend = math.sin(math.pi * min(max((t - 6) / 6, 0), 1)) ** 2
            surge = 1.8 * math.sin(math.pi * min(t / 6, 1)) ** 2 - (2.5 if 14 < t < 18 else 0)
            roll = 0.3 * bend * math.cos(1.5 * t)
            writer.writerow([t, surge, 0.7 * bend * math.sin(1.5 * t), 9.80665 + 0.4 * math.sin(9 * t) * bend, roll, 0, 0.2 * bend * math.sin(1.5 * t)])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--require", action="store_true", help="a missing browser is an error")
    parser.add_argument("--install", action="store_true", help="install what is needed first, with apt and pip")
    arguments = parser.parse_args()
    if arguments.install:
        install()
    interpreter = playwright()
    found = [browser(package) for package in BROWSERS if browser(package)]
    missing = [f"{package}: apt-get install {package}" for package in BROWSERS if not browser(package)]
    missing += [] if interpreter else [f"Playwright: pip install {PIP[0]}"]
    if missing:
        print(f"report pages: missing ({'; '.join(missing)}; or run with --install)")
        if arguments.require:
            sys.exit(1)
    if not found or not interpreter:
        print("report pages: not run")
        return
    pages = WORK / "pages"
    compile_and_run = ["cargo", "run", "--release", "--package", "moris-pages", "--example", "pages", "--"]
    check_call(*([os.environ["MORIS_PAGES"]] if "MORIS_PAGES" in os.environ else compile_and_run), pages)
    moris = [os.environ["MORIS"]] if "MORIS" in os.environ else ["cargo", "run", "--release", "--quiet", "--package", "moris", "--"]
    write_ride(pages / "ride.csv")
    check_call(*moris, "simulate", pages / "ride.csv", "--report", pages)
    scripts = {"chromium": ["checks.py", "ride.py", "live.py"], "firefox": ["checks.py", "ride.py"]}
    failed = [script for chosen in found for script in scripts["firefox" if "firefox" in Path(chosen).name else "chromium"]
              if subprocess.run([interpreter, HERE / script, chosen, pages, WORK / "pictures" / Path(chosen).name, *moris], cwd=ROOT).returncode]
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:
        sys.exit(f"failed: {' '.join(map(str, error.cmd))}")
