#!/usr/bin/env python3
"""Runs the FMUs through every importer that the package registries offer, and prints a line for each thing tried.

    python3 tests/importers/run.py [--fmus DIRECTORY] [--only IMPORTER] [--require]

The FMUs are those of all three models, of FMI 2.0 and 3.0. Each importer gets the reference ride that is in the FMU
(extra/org.fmi-standard.fmi-ls-ref), and its answers are compared with the reference output there, which the model has
computed without FMI. Importers with SSP get the whole simulator, too. Importers that cannot be installed are reported as
missing. The exit status is 1 if anything has failed or differs from the table in docs/importers.md; with --require, also if
anything is missing.

The importers are installed under target/importers, and found there the next time.
"""

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import venv
from dataclasses import dataclass
from pathlib import Path

import simulator

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
CACHE = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "importers"
VENV = CACHE / "venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
PYTHON = BIN / ("python.exe" if os.name == "nt" else "python")
PROGRAM = ".exe" if os.name == "nt" else ""
# Seconds that an importer may take; one that hangs has failed.
PATIENCE = 300


class Missing(Exception):
    """An importer cannot be had here; the text says why."""


@dataclass
class Importer:
    name: str
    version: str
    # Installs it; returns the arguments for the script, after the FMU and the directory to work in.
    install: callable
    # The script beside this one that runs it; none where it has never been seen to install.
    script: str | None
    # The name and the home page, for people.
    title: str = ""
    home: str = ""
    # Whether a registry has something that installs.
    in_registry: bool = True


def pip(*packages):
    """An installer of Python packages: several when they are needed together, the importer's own first."""

    def install():
        needed = " ".join(packages)
        mark = VENV / f"{packages[0]}.installed"
        if not mark.exists() or mark.read_text() != needed:
            done = subprocess.run(
                [PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--prefer-binary", *packages],
                capture_output=True, text=True,
            )  # fmt: skip
            if done.returncode != 0:
                raise Missing(f"pip cannot install it: {last_error(done.stderr)}")
            mark.write_text(needed)
        return []

    return install


def once(name, install):
    """An installer that is not tried again where it has failed: for what is hardly ever to be had, and slow to fail."""

    def try_once():
        mark = CACHE / f"{name}.missing"
        if mark.exists():
            raise Missing(mark.read_text())
        try:
            return install()
        except Missing as reason:
            mark.write_text(str(reason))
            raise

    return try_once


def fmi_sim(version):
    """An installer of fmi-sim, which cargo compiles; its build asks libclang to read the standard's headers."""

    def install():
        directory = CACHE / f"fmi-sim-{version}"
        program = directory / "bin" / f"fmi-sim{PROGRAM}"
        if not program.exists():
            need("cargo")
            pip("libclang")()
            find = "import clang, pathlib; print(pathlib.Path(clang.__file__).parent / 'native')"
            libclang = subprocess.run([PYTHON, "-c", find], capture_output=True, text=True, check=True).stdout.strip()
            environment = {**os.environ, "LIBCLANG_PATH": libclang}
            if shutil.which("gcc"):
                # That libclang comes without the compiler's own headers.
                headers = subprocess.run(["gcc", "-print-file-name=include"], capture_output=True, text=True, check=True)
                environment["BINDGEN_EXTRA_CLANG_ARGS"] = f"-I{headers.stdout.strip()}"
            # Not optimised: that takes a third of the time, and the ride is short.
            environment["CARGO_PROFILE_DEV_DEBUG"] = "0"
            install = ["--debug", "--locked", "--version", version, "--root", directory]
            cargo("install", *install, "fmi-sim", environment=environment)
            shutil.rmtree(compiled("fmi-sim"), ignore_errors=True)
        return [program]

    return install


def fmu_runner():
    need("cargo")
    manifest = HERE / "fmu-runner" / "Cargo.toml"
    cargo("build", "--locked", "--release", "--manifest-path", manifest)
    return [compiled("fmu-runner") / "release" / f"with-fmu-runner{PROGRAM}"]


def omsimulator():
    """OMSimulator that somebody has built: its package downloads the program from a site of its own."""
    prefix = Path(os.environ.get("OMSIMULATOR", CACHE / "OMSimulator"))
    library = next(iter(sorted(prefix.glob("**/libOMSimulator.so"))), None)
    if library is None:
        raise Missing("build it from its sources, as docs/importers.md says, and set OMSIMULATOR to where it is installed")
    return [library]


MODELS = ["MorisWashout", "Motorcycle", "StewartPlatform"]
COLUMNS = ["2.0", "3.0", "SSP"]
TABLE = ROOT / "docs" / "importers.md"

IMPORTERS = [
    Importer("fmpy", "0.3.32", pip("fmpy==0.3.32"), "with_fmpy.py", "FMPy", "https://github.com/CATIA-Systems/FMPy"),
    Importer(
        "OMSimulator", "3.0.0.post114", omsimulator, "with_omsimulator.py", "OMSimulator",
        "https://github.com/OpenModelica/OMSimulator", in_registry=False,
    ),
    Importer(
        "ecospy", "0.7.2", pip("ecospy==0.7.2", "tbb==2023.2.0"), "with_ecospy.py", "Ecos",
        "https://github.com/Ecos-platform/ecos",
    ),
    Importer(
        "libcosimpy", "0.0.6", pip("libcosimpy==0.0.6"), "with_libcosimpy.py", "libcosim",
        "https://open-simulation-platform.github.io",
    ),
    Importer(
        "fmu-manipulation-toolbox", "2.0", pip("fmu-manipulation-toolbox==2.0"), "with_fmu_manipulation_toolbox.py",
        "FMU manipulation toolbox", "https://github.com/grouperenault/fmu_manipulation_toolbox",
    ),
    Importer(
        "fmuloader", "0.1.2rc0", pip("fmuloader==0.1.2rc0"), "with_fmuloader.py", "fmuloader",
        "https://github.com/time-integral/fmuloader",
    ),
    Importer("fmi-sim", "0.7.0", fmi_sim("0.7.0"), "with_fmi_sim.py", "fmi-sim", "https://github.com/jondo2010/rust-fmi"),
    Importer(
        "fmu-runner", "0.4.4", fmu_runner, "with_fmu_runner.py", "fmu-runner", "https://github.com/Nikita240/fmu-runner-rs"
    ),
    Importer("pyfmi", "2.5", once("pyfmi", pip("pyfmi==2.5")), None, in_registry=False),
]


def need(program):
    if not shutil.which(program):
        raise Missing(f"{program} is not installed")


def cargo(command, *arguments, environment=None):
    """Runs cargo with a target directory of its own for each crate."""
    crate = "fmi-sim" if command == "install" else "fmu-runner"
    line = ["cargo", command, "--target-dir", compiled(crate), *arguments]
    if subprocess.run(line, env=environment).returncode != 0:
        raise Missing(f"cargo cannot {command} it, see above")


def compiled(crate):
    return CACHE / "compiled" / crate


def last_error(text):
    """The last line that says what is wrong."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    # pip's own "error: subprocess-exited-with-error" says nothing.
    errors = [line for line in lines if re.search(r"\w*[Ee]rror: ", line) and "subprocess-exited" not in line]
    return (errors or lines or ["it does not say why"])[-1][:140]


HEADER = "| importer | FMI 2.0 | FMI 3.0 | SSP |\n|---|---|---|---|"


def row(importer, results):
    """The importer's row in the table: in each column whether all was right, and the number of models of a version."""
    cells = []
    for column in COLUMNS:
        mine = [result for result in results if result["column"] == column]
        models = {model for model in MODELS for result in mine if result["what"].startswith(f"{model}, FMI {column}")}
        if not mine:
            cells.append("no")
        elif any(result["verdict"] != "ok" for result in mine):
            cells.append("FAILED")
        else:
            cells.append(f"{len(models)} models" if column != "SSP" else "yes")
    return f"| [{importer.title}]({importer.home}) {importer.version} | {' | '.join(cells)} |"


@dataclass
class Outcome:
    importer: Importer
    results: list
    # Why it was not run; none if it was.
    missing: str | None = None
    failed: bool = False


def try_out(importer, fmus):
    """Installs and runs an importer, and prints a line for each thing tried."""
    try:
        arguments = importer.install()
        if importer.script is None:
            raise Missing("it installs here, but there is no script for it yet")
    except Missing as reason:
        show(importer, "-", "-", f"missing ({reason})")
        return Outcome(importer, [], missing=str(reason))
    work = CACHE / "work" / importer.script.removesuffix(".py")
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}
    if sys.platform == "linux":
        # Where the wheel of tbb, which ecospy needs, puts its library.
        environment["LD_LIBRARY_PATH"] = str(VENV / "lib")
    command = [PYTHON, HERE / importer.script, fmus, work, *arguments]
    try:
        done = subprocess.run(
            [str(part) for part in command], env=environment, cwd=work, capture_output=True, text=True, timeout=PATIENCE
        )
    except subprocess.TimeoutExpired:
        show(importer, "-", "-", f"FAILED (not done after {PATIENCE} s)")
        return Outcome(importer, [], failed=True)
    (work / "log.txt").write_text(done.stdout + done.stderr)
    results = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"what"')]
    for result in results:
        show(importer, result["what"], result["difference"], result["verdict"])
    if done.returncode != 0 or not results:
        ended = f"killed by {signal.Signals(-done.returncode).name}" if done.returncode < 0 else last_error(done.stderr)
        show(importer, "-", "-", f"FAILED ({ended}; see {work / 'log.txt'})")
        return Outcome(importer, results, failed=True)
    return Outcome(importer, results, failed=any(result["verdict"] != "ok" for result in results))


def print_table(outcomes):
    """Prints the table of docs/importers.md as it came out here; returns whether the page agrees with it."""
    said = TABLE.read_text()
    wrong = []
    print(f"\n{HEADER}")
    for outcome in outcomes:
        if not outcome.results:
            continue
        line = row(outcome.importer, outcome.results)
        print(line)
        if line not in said:
            wrong.append(line)
    for outcome in outcomes:
        if outcome.missing:
            print(f"Not run: {outcome.importer.title or outcome.importer.name}: {outcome.missing}")
    for line in wrong:
        print(f"FAILED: {TABLE.name} does not say: {line}")
    return not wrong


def show(importer, what, difference, verdict):
    name = f"{importer.name} {importer.version}"
    print(f"{name:30}{what:52}{difference:>10}  {verdict}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmus", type=Path, default=ROOT / "target" / "fmu", help="directory of the FMUs [default: %(default)s]")
    parser.add_argument("--only", action="append", choices=[importer.name for importer in IMPORTERS], help="default: all")
    parser.add_argument("--require", action="store_true", help="an importer that a registry has must not be missing")
    arguments = parser.parse_args()
    directory = arguments.fmus.resolve()
    needed = [directory / f"{model}.{kind}" for kind in ("fmu", "fmi3.fmu") for model in MODELS]
    needed += [directory / f"{system}.{kind}" for system in simulator.SYSTEMS for kind in ("ssp", "flat.ssp")]
    if lacking := [path for path in needed if not path.exists()]:
        sys.exit(f"{lacking[0]} is missing: run `cargo build-fmu`, with --fmi 3 too, and `cargo build-ssp`, with --flat and --system MotorcycleLap too")
    fmus = ",".join(str(path) for path in needed if path.suffix == ".fmu")
    if not PYTHON.exists():
        venv.create(VENV, with_pip=True)
    print(f"{'importer':30}{'what was run':52}{'difference':>10}  verdict")
    chosen = [importer for importer in IMPORTERS if not arguments.only or importer.name in arguments.only]
    outcomes = [try_out(importer, fmus) for importer in chosen]
    # The table is that of Linux: some importers have no binaries for other systems.
    agrees = sys.platform != "linux" or print_table(outcomes)
    lacks = arguments.require and any(outcome.missing and outcome.importer.in_registry for outcome in outcomes)
    sys.exit(1 if lacks or not agrees or any(outcome.failed for outcome in outcomes) else 0)


if __name__ == "__main__":
    main()
