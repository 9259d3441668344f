#!/usr/bin/env python3
"""Compiles the sources in the washout's FMUs with C compilers, and compares them with the libraries.

    python3 tests/sources/run.py [--install] [--require]

FMPy compiles the FMUs of FMI 2.0 and 3.0 with CMake. The reference ride with each strategy has to give the numbers of the
library that was compiled from Rust, to the bit. A program that includes the sources checks states, refusals, traps and that a
step allocates nothing. Callgrind counts the instructions of a step in both. What is not installed is reported as missing;
with --require that is an error. With --install it is installed first (apt and rustup).
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "importers")]
from installing import add_rust_targets, install_packages  # noqa: E402
from ride import Ride  # noqa: E402

TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
WORK = TARGET / "sources"
VENV = WORK / "venv"
APT = ["gcc", "wabt", "valgrind"]
RUSTUP = ["wasm32-unknown-unknown"]
# With CMake, which FMPy calls.
PIP = ["fmpy==0.3.32"]
MODEL = "MorisWashout"
# The FMU's ending, the library's directory, and the option for a shared library.
VERSIONS = {
    "2": (".fmu", "linux64", "FMI2_OVERRIDE_FUNCTION_PREFIX"),
    "3": (".fmi3.fmu", "x86_64-linux", "FMI3_OVERRIDE_FUNCTION_PREFIX"),
}
STRATEGIES = [{}, {"strategy": 2}, {"strategy": 3}, {"strategy": 4}, {"strategy": 5}]
WARNINGS = ["-std=c99", "-Wpedantic", "-Werror"]
# Instructions of a step, in relation to the library compiled from Rust: for any strategy.
MOST_INSTRUCTIONS = 2.0
INPUTS = ["vehicle.specificForce.x", "vehicle.specificForce.y", "vehicle.angularVelocity.z"]
OUTPUTS = [f"actuator[{leg}].length" for leg in range(1, 7)]


class Missing(Exception):
    """Something is not installed; the text says what."""


def run(*command, **options):
    return subprocess.run([str(part) for part in command], check=True, cwd=ROOT, **options)


def install():
    install_packages(*APT)
    add_rust_targets(*RUSTUP)


def need(program, package):
    if not shutil.which(program):
        raise Missing(f"{program}: apt-get install {package}")
    return program


def build():
    """The FMUs with sources, unpacked."""
    need("wasm2c", "wabt")
    run("cargo", "build-fmu", "--model", MODEL, "--fmi", ",".join(VERSIONS), "--sources", "--output", WORK)
    for ending, *_ in VERSIONS.values():
        with zipfile.ZipFile(WORK / f"{MODEL}{ending}") as archive:
            archive.extractall(directory(ending))


def directory(ending):
    return WORK / f"unpacked{ending}"


def library(version):
    ending, platform, _ = VERSIONS[version]
    return directory(ending) / "binaries" / platform / f"{MODEL}.so"


def interpreter(directory, packages):
    """That of a virtual environment with these packages."""
    python = directory / "bin" / "python"
    if not (directory / "ready").exists():
        venv.create(directory, with_pip=True)
        run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages)
        (directory / "ready").touch()
    return python


def compiled_by_fmpy(version):
    """The library that FMPy makes of the sources."""
    python = interpreter(VENV, PIP)
    ending, platform, _ = VERSIONS[version]
    copy = WORK / f"compiled{ending}"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(directory(ending), copy)
    made = copy / "binaries" / platform / f"{MODEL}.so"
    made.unlink()
    code = f"from fmpy.build import build_platform_binary; build_platform_binary({str(copy)!r})"
    environment = os.environ | {"PATH": f"{VENV / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    run(python, "-c", code, env=environment, stdout=subprocess.DEVNULL)
    return made


def answers(host, library, version, ride, settings):
    done = subprocess.run([host, library, version, ride.guid], input=ride.for_host(settings), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == ride.steps, "steps are missing"
    return done.stdout


def instructions(host, library, version, ride, settings):
    """Those of all steps of the ride."""
    counted = [need("valgrind", "valgrind"), "--tool=callgrind", "--callgrind-out-file=/dev/null", f"--toggle-collect=fmi{version}DoStep"]
    done = subprocess.run(
        [*counted, host, library, version, ride.guid], input=ride.for_host(settings), capture_output=True, text=True, check=True
    )
    return int(re.search(r"Collected : (\d+)", done.stderr)[1])


def compile_host():
    host = WORK / "host"
    run("gcc", "-std=c99", "-O1", "-o", host, ROOT / "tests" / "platforms" / "host.c", "-ldl")
    return host


def check_rides():
    host = compile_host()
    for version, (ending, *_) in VERSIONS.items():
        ride, own, made = Ride(WORK / f"{MODEL}{ending}"), library(version), compiled_by_fmpy(version)
        for settings in STRATEGIES:
            expected = answers(host, own, version, ride, settings)
            assert expected == answers(host, made, version, ride, settings), f"FMI {version}, {settings}: other numbers"
        print(f"FMI {version}: compiled by FMPy, {len(STRATEGIES)} rides equal to the bit", flush=True)
        for settings in (STRATEGIES[0], STRATEGIES[3]):
            ratio = instructions(host, made, version, ride, settings) / instructions(host, own, version, ride, settings)
            print(f"FMI {version}, {settings or 'strategy 1'}: {ratio:.2f} times the instructions of a step", flush=True)
            assert ratio <= MOST_INSTRUCTIONS, "a step costs too much"


def check_included():
    """The same sources within a program, by the C compiler alone; and that it has nothing to warn of."""
    ending, *_ = VERSIONS["2"]
    ride, sources = Ride(WORK / f"{MODEL}{ending}"), directory(ending) / "sources"
    program = WORK / "included"
    run("gcc", *WARNINGS, "-O1", "-I", sources, "-o", program, HERE / "included.c", "-lm")
    references = [ride.references[name] for name in INPUTS + OUTPUTS]
    run(program, ride.guid, *references)
    print("FMI 2: states, refusals, a trap, and no allocation in a step", flush=True)


def check_start_values():
    """Start values in the sources, which the C compiler alone makes a library."""
    ending, platform, define = VERSIONS["2"]
    folder = WORK / "paper"
    run("cargo", "build-fmu", "--model", MODEL, "--sources", "--parameters", "paper", "--output", folder)
    with zipfile.ZipFile(folder / f"{MODEL}{ending}") as archive:
        archive.extractall(folder)
    made = folder / "made.so"
    run("gcc", *WARNINGS, f"-D{define}", "-O1", "-shared", "-fPIC", "-o", made, folder / "sources" / f"{MODEL}.c", "-lm")
    host, ride = compile_host(), Ride(folder / f"{MODEL}{ending}")
    own = folder / "binaries" / platform / f"{MODEL}.so"
    expected = answers(host, own, "2", ride, {})
    assert expected != answers(host, library("2"), "2", Ride(WORK / f"{MODEL}{ending}"), {}), "the parameters change nothing"
    assert expected == answers(host, made, "2", ride, {}), "other numbers with start values"
    print("FMI 2: compiled by GCC alone with other start values, equal to the bit", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--install", action="store_true", help="install what is needed first, with apt and rustup")
    parser.add_argument("--require", action="store_true", help="what is missing is an error")
    options = parser.parse_args()
    require = options.require
    if sys.platform != "linux":
        print("sources: missing (they are compiled on Linux only)")
        sys.exit(1 if require else 0)
    WORK.mkdir(parents=True, exist_ok=True)
    if options.install:
        install()
    try:
        need("gcc", "gcc")
        need("valgrind", "valgrind")
        build()
        check_included()
        check_start_values()
        check_rides()
    except Missing as reason:
        print(f"sources: missing ({reason})")
        sys.exit(1 if require else 0)
    except AssertionError as failure:
        sys.exit(f"FAILED: {failure}")


if __name__ == "__main__":
    main()
