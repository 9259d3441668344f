#!/usr/bin/env python3
"""Runs the libraries of all FMUs for other platforms, Windows' under Wine and Arm's under qemu, against those for Linux.

    python3 tests/platforms/run.py [--require] [--install]

Each library, of all three models and of FMI 2.0 and 3.0, makes the reference ride that is in its FMU. The host in host.c
steps it. The washout makes it with each strategy, the motorcycle also on a path. The numbers have to be those of the library
for linux64, to the bit. Where a program is not installed, the platform is reported as missing; with --require that is an error. With --install everything needed is installed first (apt, rustup and
pip; for Debian and Ubuntu).
"""

import argparse
import os
import platform
import shutil
import subprocess
import sys
import venv
import zipfile
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "importers")]
from installing import add_rust_targets, install_packages  # noqa: E402
from ride import TOLERANCE, Ride  # noqa: E402

WORK = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "platforms"
VENV = WORK / "venv"
MODELS = ["MorisWashout", "Motorcycle", "StewartPlatform"]
# The word for build-fmu, and how the files of that version end.
VERSIONS = {"2": ".fmu", "3": ".fmi3.fmu"}
# Enumerations that a ride sets before it begins: each model as it is, the washout's other strategies, the motorcycle on a path.
RIDES = {
    "MorisWashout": [{}, {"strategy": 1}, {"strategy": 2}, {"strategy": 3}, {"strategy": 5}],
    "Motorcycle": [{}, {"path.course": 6}],
    "StewartPlatform": [{}],
}
ARM_LIBRARIES = Path("/usr/aarch64-linux-gnu")

APT = ["gcc-mingw-w64-x86-64", "wine64", "qemu-user", "libc6-arm64-cross"]
PIP = ["cargo-zigbuild==0.24.0", "ziglang==0.17.0"]
RUSTUP = ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-gnu", "aarch64-unknown-linux-gnu"]


class Missing(Exception):
    """Something is not installed; the text says what."""


@dataclass
class Platform:
    name: str
    # Its directory in an FMU of FMI 3.0; in one of FMI 2.0 it is the name.
    tuple: str
    # How its libraries end.
    ending: str
    # Returns the compiler for the host.
    compiler: callable
    # Returns what runs a program of that platform here, and its name for people.
    emulator: callable


def zig_for(target):
    def compiler():
        zig = next((zig for zig in (["zig"], ["python3", "-m", "ziglang"]) if runs([*zig, "version"])), None)
        if zig is None:
            raise Missing("zig: pip install ziglang")
        return [*zig, "cc", "-target", target]

    return compiler


def mingw():
    # zig would compile the whole C library for Windows first.
    program = shutil.which("x86_64-w64-mingw32-gcc")
    if not program:
        raise Missing("GCC for Windows: apt-get install gcc-mingw-w64-x86-64")
    return [program]


def itself():
    return [], "this machine"


def wine():
    program = shutil.which("wine64") or shutil.which("wine64", path="/usr/lib/wine") or shutil.which("wine")
    if not program:
        raise Missing("Wine: apt-get install wine64")
    return [program], version(program).split()[0]


def qemu():
    program = shutil.which("qemu-aarch64")
    if not program:
        raise Missing("qemu: apt-get install qemu-user")
    if not (ARM_LIBRARIES / "lib" / "ld-linux-aarch64.so.1").exists():
        raise Missing("the C library for Arm: apt-get install libc6-arm64-cross")
    return [program, "-L", str(ARM_LIBRARIES)], "qemu " + version(program).split("version ")[-1].split()[0]


def version(program):
    done = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    return done.stdout.splitlines()[0]


LINUX = Platform("linux64", "x86_64-linux", ".so", zig_for("x86_64-linux-gnu.2.17"), itself)
OTHERS = [
    Platform("win64", "x86_64-windows", ".dll", mingw, wine),
    Platform("aarch64-linux", "aarch64-linux", ".so", zig_for("aarch64-linux-gnu.2.17"), qemu),
]


def environment():
    """The environment for the tools, those that --install has put under target included."""
    wine_home = {"WINEPREFIX": str(WORK / "wine"), "WINEDEBUG": "-all"}
    return {**os.environ, **wine_home, "PATH": f"{VENV / 'bin'}{os.pathsep}{os.environ['PATH']}"}


def call(command, **options):
    return subprocess.run([str(part) for part in command], env=environment(), cwd=ROOT, capture_output=True, text=True, **options)


def check_call(command):
    print("$", *command, flush=True)
    subprocess.run([str(part) for part in command], env=environment(), cwd=ROOT, check=True)


def install():
    install_packages(*APT)
    add_rust_targets(*RUSTUP)
    if not (VENV / "bin" / "python").exists():
        venv.create(VENV, with_pip=True)
    check_call([VENV / "bin" / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PIP])


def build_fmus(chosen):
    """Builds the FMUs of all models and versions for a platform; returns their directory."""
    directory = WORK / chosen.name
    print(f"building the FMUs for {chosen.name} ...", flush=True)
    done = call(["cargo", "build-fmu", "--fmi", ",".join(VERSIONS), "--platform", chosen.name, "--output", directory])
    if done.returncode != 0:
        reason = done.stderr.strip().splitlines()[-1].removeprefix("error: ")
        if "is not installed" in reason:
            raise Missing(reason)
        raise AssertionError(f"{chosen.name} cannot be built:\n{done.stdout}{done.stderr}")
    return directory


def unpack_library(chosen, model, fmu, version):
    """Takes the library out of an FMU."""
    binaries = f"binaries/{chosen.name if version == '2' else chosen.tuple}"
    with zipfile.ZipFile(fmu) as archive:
        return archive.extract(f"{binaries}/{model}{chosen.ending}", fmu.with_suffix(""))


def build_host(chosen):
    """Compiles host.c for a platform."""
    program = WORK / chosen.name / ("host.exe" if chosen.name.startswith("win") else "host")
    source = HERE / "host.c"
    if not program.exists() or program.stat().st_mtime < source.stat().st_mtime:
        flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror"]
        done = call([*chosen.compiler(), *flags, "-o", program, source])
        assert done.returncode == 0, f"host.c does not compile for {chosen.name}:\n{done.stderr}"
    return program


def runs(command):
    try:
        return call(command).returncode == 0
    except FileNotFoundError:
        return False


@dataclass
class Answers:
    """What a library answered to its reference ride: a row of outputs for each step."""

    ride: Ride
    settings: dict
    rows: list


def ride_on(chosen, emulator):
    """Makes the rides of each FMU on a platform; returns the answers in the same order for every platform."""
    directory, host = build_fmus(chosen), build_host(chosen)
    return [
        ride_with(chosen, [*emulator, host], model, directory / f"{model}{ending}", version, settings)
        for model in MODELS
        for version, ending in VERSIONS.items()
        for settings in RIDES[model]
    ]


def ride_with(chosen, host, model, fmu, version, settings):
    ride = Ride(fmu)
    done = call([*host, unpack_library(chosen, model, fmu, version), version, ride.guid], input=ride.for_host(settings))
    what = f"{model}, FMI {ride.fmi}, on {chosen.name}"
    assert done.returncode == 0, f"{what} ended with {done.returncode}:\n{done.stderr}"
    rows = [list(map(float, line.split())) for line in done.stdout.splitlines()]
    assert len(rows) == ride.steps, f"{what} gave {len(rows)} answers to {ride.steps} steps"
    return Answers(ride, settings, rows)


def report(name, by, answers, largest, limit, of_what):
    passed = largest <= limit
    what = ", ".join([answers.ride.model, f"FMI {answers.ride.fmi}", *(f"{name} {item}" for name, item in answers.settings.items())])
    verdict = "ok" if passed else f"FAILED (more than {limit:.0e})"
    print(f"{name:15}{by:14}{what:43}{largest:.1e} from {of_what:22}{verdict}", flush=True)
    return passed


def largest_difference(rows, expected):
    return max(abs(a - b) for row, reference in zip(rows, expected, strict=True) for a, b in zip(row, reference, strict=True))


def compare():
    """Runs every platform; returns whether none has failed, and whether none is missing."""
    passed, complete = True, True
    try:
        emulator, by = LINUX.emulator()
        expected = ride_on(LINUX, emulator)
    except Missing as reason:
        print(f"{LINUX.name:15}missing ({reason})")
        return True, False
    for answers in expected:
        if answers.settings:
            # The reference output is of the start values; a setting changes it.
            own = next(it for it in expected if not it.settings and (it.ride.model, it.ride.fmi) == (answers.ride.model, answers.ride.fmi))
            assert answers.rows != own.rows, f"{answers.settings} changes nothing in {answers.ride.model}"
            continue
        largest = answers.ride.difference({k + 1: row for k, row in enumerate(answers.rows)})
        passed &= report(LINUX.name, by, answers, largest, TOLERANCE, "the reference output")
    for other in OTHERS:
        try:
            emulator, by = other.emulator()
            rides = ride_on(other, emulator)
        except Missing as reason:
            print(f"{other.name:15}missing ({reason})", flush=True)
            complete = False
            continue
        for answers, reference in zip(rides, expected, strict=True):
            largest = largest_difference(answers.rows, reference.rows)
            passed &= report(other.name, by, answers, largest, 0.0, "linux64")
    return passed, complete


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--require", action="store_true", help="a platform that cannot be run is an error")
    parser.add_argument("--install", action="store_true", help="install what is needed first, with apt, rustup and pip")
    arguments = parser.parse_args()
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        print("other platforms: missing (they are run on Linux on x86-64 only)")
        sys.exit(1 if arguments.require else 0)
    WORK.mkdir(parents=True, exist_ok=True)
    if arguments.install:
        install()
    try:
        passed, complete = compare()
    except AssertionError as failure:
        print(f"FAILED: {failure}")
        sys.exit(1)
    sys.exit(0 if passed and (complete or not arguments.require) else 1)


if __name__ == "__main__":
    main()
