#!/usr/bin/env python3
"""Runs the FMU through every importer that the package registries offer, and prints a line for each thing tried.

    python3 tests/importers/run.py [--fmu FMU] [--only IMPORTER] [--require]

Each importer gets the reference ride that is in the FMU (extra/org.fmi-standard.fmi-ls-ref), and its answers are compared
with the reference output there, which the washout has computed without FMI. What cannot be installed is reported as missing. The
exit status is 1 if anything has failed; with --require, also if anything is missing.

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


def pip(*packages):
    """An installer of Python packages: several when they are needed together, the importer's own first."""

    def install():
        wanted = " ".join(packages)
        mark = VENV / f"{packages[0]}.installed"
        if not mark.exists() or mark.read_text() != wanted:
            done = subprocess.run(
                [PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--prefer-binary", *packages],
                capture_output=True, text=True,
            )  # fmt: skip
            if done.returncode != 0:
                raise Missing(f"pip cannot install it: {last_error(done.stderr)}")
            mark.write_text(wanted)
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
            print(f"compiling fmi-sim {version}, once ...", flush=True)
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


IMPORTERS = [
    Importer("fmpy", "0.3.32", pip("fmpy==0.3.32"), "with_fmpy.py"),
    Importer("fmi-sim", "0.7.0", fmi_sim("0.7.0"), "with_fmi_sim.py"),
    Importer("fmu-runner", "0.4.4", fmu_runner, "with_fmu_runner.py"),
    Importer("libcosimpy", "0.0.6", pip("libcosimpy==0.0.6"), "with_libcosimpy.py"),
    Importer("ecospy", "0.7.2", pip("ecospy==0.7.2", "tbb==2023.2.0"), "with_ecospy.py"),
    Importer("fmu-manipulation-toolbox", "2.0", pip("fmu-manipulation-toolbox==2.0"), "with_fmu_manipulation_toolbox.py"),
    Importer("OMSimulator", "3.0.0.post198", once("OMSimulator", pip("OMSimulator==3.0.0.post198")), None),
    Importer("pyfmi", "2.5", once("pyfmi", pip("pyfmi==2.5")), None),
]


def need(program):
    if not shutil.which(program):
        raise Missing(f"{program} is not installed")


def cargo(command, *arguments, environment=None):
    """Runs cargo with a target directory of its own for each crate."""
    crate = "fmi-sim" if command == "install" else "fmu-runner"
    line = ["cargo", command, "--quiet", "--target-dir", compiled(crate), *arguments]
    done = subprocess.run(line, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise Missing(f"cargo cannot {command} it: {last_error(done.stderr)}")


def compiled(crate):
    return CACHE / "compiled" / crate


def last_error(text):
    """The last line that says what is wrong."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    # pip's own "error: subprocess-exited-with-error" says nothing.
    errors = [line for line in lines if re.search(r"\w*[Ee]rror: ", line) and "subprocess-exited" not in line]
    return (errors or lines or ["it does not say why"])[-1][:140]


def try_out(importer, fmu, required):
    """Installs and runs an importer; prints its lines; returns whether nothing has failed, nor lacks that is required."""
    try:
        arguments = importer.install()
        if importer.script is None:
            raise Missing("it installs here, but there is no script for it yet")
    except Missing as reason:
        show(importer, "-", "-", f"missing ({reason})")
        return not required
    work = CACHE / "work" / importer.script.removesuffix(".py")
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}
    if sys.platform == "linux":
        # Where the wheel of tbb, which ecospy needs, puts its library.
        environment["LD_LIBRARY_PATH"] = str(VENV / "lib")
    command = [PYTHON, HERE / importer.script, fmu, work, *arguments]
    try:
        done = subprocess.run(
            [str(part) for part in command], env=environment, cwd=work, capture_output=True, text=True, timeout=PATIENCE
        )
    except subprocess.TimeoutExpired:
        show(importer, "-", "-", f"FAILED (not done after {PATIENCE} s)")
        return False
    (work / "log.txt").write_text(done.stdout + done.stderr)
    results = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"what"')]
    for result in results:
        show(importer, result["what"], result["difference"], result["verdict"])
    if done.returncode != 0 or not results:
        ended = f"killed by {signal.Signals(-done.returncode).name}" if done.returncode < 0 else last_error(done.stderr)
        show(importer, "-", "-", f"FAILED ({ended}; see {work / 'log.txt'})")
        return False
    return all(result["verdict"] == "ok" for result in results)


def show(importer, what, difference, verdict):
    name = f"{importer.name} {importer.version}"
    print(f"{name:30}{what:52}{difference:>10}  {verdict}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=ROOT / "target" / "fmu" / "MorisWashout.fmu", help="default: %(default)s")
    parser.add_argument("--only", action="append", choices=[importer.name for importer in IMPORTERS], help="default: all")
    parser.add_argument("--require", action="store_true", help="an importer that is missing is an error")
    arguments = parser.parse_args()
    fmu = arguments.fmu.resolve()
    if not fmu.exists():
        sys.exit(f"{fmu} is missing: run `cargo build-fmu`")
    if not PYTHON.exists():
        venv.create(VENV, with_pip=True)
    print(f"{'importer':30}{'what was run':52}{'difference':>10}  verdict")
    chosen = [importer for importer in IMPORTERS if not arguments.only or importer.name in arguments.only]
    passed = [try_out(importer, fmu, arguments.require) for importer in chosen]
    sys.exit(0 if all(passed) else 1)


if __name__ == "__main__":
    main()
