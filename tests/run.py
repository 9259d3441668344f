#!/usr/bin/env python3
"""Runs the tests, part by part, and prints how long each part took.

    python3 tests/run.py [--all] [--only PART ...] [-k EXPRESSION] [--install] [--require]

The default is what a change can break, in few cases where a test is a search. --all adds importers, other platforms and
pages, all cases, and the optimised Python package that users get.

With --install what other platforms and the pages need is installed first; with --require it is an error where it is missing.
What a test needs and this machine lacks is listed at the end. The requirements of README are checked before anything is compiled.
"""

import argparse
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import time
import venv
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from pathlib import Path

from book import install as install_mdbook
from installing import add_rust_targets, install_packages

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
VENV = TARGET / "venv"
REQUIREMENTS = ROOT / "tests" / "python" / "requirements.txt"
PROGRAM = ".exe" if os.name == "nt" else ""
LONGEST = ("live", "building", "washout")
"""Test programs that wait for clocks and for cargo, or simulate for long."""
NO_TESTS = 5
"""pytest's exit status if an expression selects none."""
OLDEST_PYTHON = (3, 10)
WEBASSEMBLY = "wasm32-unknown-unknown"
BOARD_TARGETS = ("thumbv7em-none-eabihf", "thumbv7m-none-eabi")
BOARD_TOOLS = ("gcc-arm-none-eabi", "qemu-system-arm")
LACKING_LINE = re.compile(r"SKIPPED \[\d+\] (?P<test>\S+?)(:\d+)?: (?P<reason>needs .*)|(?P<part>\S.*?):? +missing \((?P<what>.*)\)")
"""A line of pytest, or of a script beside this one, that says what this machine lacks."""
lacking = []
"""What tests need and this machine lacks, in the order in which it was met."""


def refusals():
    """Yields what README requires and this machine lacks, each in one line with the remedy."""
    if sys.version_info < OLDEST_PYTHON:
        oldest, this = (".".join(map(str, version[:2])) for version in (OLDEST_PYTHON, sys.version_info))
        yield f"Python {oldest} or newer is needed, and this is {this}: run tests/run.py with a newer one"
    elif not importlib.util.find_spec("ensurepip"):
        package = "python{}.{}-venv".format(*sys.version_info)
        yield f"Python's module ensurepip is needed for a virtual environment: on Debian and Ubuntu, apt install {package}"
    if not shutil.which("cargo") or not shutil.which("rustc"):
        yield "cargo and rustc are needed: install Rust from https://rustup.rs"
    else:
        oldest = re.search(r'^rust-version = "(.+)"', (ROOT / "Cargo.toml").read_text(), re.MULTILINE).group(1)
        printed = subprocess.run(["rustc", "--version"], cwd=str(ROOT), stdout=subprocess.PIPE).stdout.decode()
        this = printed.split()[1] if printed else "0.0"
        if not printed:
            yield "rustc does not run: rustup default stable chooses a toolchain"
        elif [int(part) for part in this.split(".")[:2]] < [int(part) for part in oldest.split(".")]:
            yield f"Rust {oldest} or newer is needed, and this is {this}: run rustup update, or install Rust from https://rustup.rs"
    has_linker = shutil.which("cc") or any(name.startswith("CARGO_TARGET_") and name.endswith("_LINKER") for name in os.environ)
    if sys.platform == "linux" and not has_linker:
        yield "a C compiler is needed, with which Rust links: on Debian and Ubuntu, apt install gcc libc6-dev"


def usable_cores():
    """The cores that this process may use, where the system tells."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


def run(*command, allowed=(0,), at_once=False, are_tests=False, **environment):
    """Runs a command and ends if it fails.

    With `at_once` its output comes at its end, for commands beside each other. With `are_tests` the output is searched for what
    the tests lack.
    """
    print("$", *command, flush=True)
    output = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT} if at_once or are_tests else {}
    process = subprocess.Popen([str(part) for part in command], cwd=ROOT, env=os.environ | environment, **output)
    lines = []
    for line in process.stdout or ():
        lines.append(line.decode(errors="replace"))
        if not at_once:
            print(lines[-1], end="", flush=True)
    status = process.wait()
    if at_once:
        print(*lines, sep="", end="", flush=True)
    found = filter(None, (LACKING_LINE.match(line) for line in lines))
    lacking.extend(f"{one['test']}: {one['reason']}" if one["test"] else f"{one['part']}: needs {one['what']}" for one in found)
    if status not in allowed:
        sys.exit(f"failed: {' '.join(map(str, command))}")


def python():
    """The virtual environment's interpreter; the environment is made where it is missing or out of date."""
    interpreter = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    installed = VENV / "requirements.txt"
    if not installed.exists() or installed.read_text() != REQUIREMENTS.read_text():
        venv.create(VENV, with_pip=True, clear=True)
        run(interpreter, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", REQUIREMENTS)
        installed.write_text(REQUIREMENTS.read_text())
    return interpreter


def cases(options):
    """The variable by which tests that search try all cases."""
    return {"MORIS_ALL_CASES": "1"} if options.all else {}


def pytest(options, processes, *arguments):
    """Runs tests in so many processes, or in two where no other part runs beside."""
    chosen = ["-k", options.k] if options.k else []
    allowed = (0, NO_TESTS) if options.k else (0,)
    processes = processes if options.beside else 2
    command = [python(), "-m", "pytest", "--quiet", "-rs", "--numprocesses", str(processes), *chosen, *arguments]
    # The pages' commands run with the tools as the tests compile them: optimised ones take minutes more to compile. Without a
    # package, cargo takes the features of all, so that each library is compiled once.
    environment = cases(options) | {
        # Threads for matrices of ten rows cost more than they save.
        "OPENBLAS_NUM_THREADS": "1",
        "CARGO_ALIAS_FIRST_RIDE": "run --bin first-ride",
        "CARGO_ALIAS_MORIS": "run --bin moris --",
        "CARGO_ALIAS_LIVE": "run --bin moris-live --",
        "CARGO_ALIAS_HUNTER": "run --bin hunter --",
    }
    run(*command, allowed=allowed, at_once=options.beside, are_tests=True, **environment)


def fmu(options):
    """builds the FMUs of both versions and the packages of the simulator"""
    run("cargo", "build-fmu", "--fmi", "2,3")
    # All libraries are compiled by now.
    packed = [("build-fmu", "--fmi", "3", "--arrays"), ("build-fmu", "--reals-only")]
    packed += [("build-fmu", "--terminals", "--output", TARGET / "fmu" / "terminals")]
    packed += [("build-ssp", "--system", system, *form) for system in ("MotorcycleSimulator", "MotorcycleLap") for form in ([], ["--flat"])]
    with ThreadPoolExecutor(usable_cores()) as pool:
        for _ in pool.map(lambda command: run("cargo", *command, at_once=True), packed):
            pass


def test_programs(command):
    """Compiles the test programs. Returns them, each with its package's directory; those that take long come first."""
    command = [*command, "--no-run", "--message-format", "json-render-diagnostics"]
    print("$", *command, flush=True)
    report = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE)
    if report.returncode:
        sys.exit(f"failed: {' '.join(command)}")
    artifacts = [json.loads(line) for line in report.stdout.splitlines() if b'"executable":"' in line]
    programs = [(one["executable"], Path(one["manifest_path"]).parent) for one in artifacts if one["profile"]["test"]]
    assert programs, "cargo names no test program"
    return sorted(programs, key=lambda program: (named(program[0]) not in LONGEST, -Path(program[0]).stat().st_size))


def named(program):
    """A test program's name as its package has it."""
    return Path(program).stem.rsplit("-", 1)[0]


def failure(program, directory, *arguments, **environment):
    """The exit status and the output of a command that fails, else nothing."""
    done = subprocess.run([program, *arguments], cwd=directory, env=os.environ | environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    output = done.stdout.decode(errors="replace")
    print("$", Path(program).name, *output.strip().splitlines()[-1:], flush=True)
    return f"{program}: exit status {done.returncode}\n{output}" if done.returncode else ""


def rust(options):
    """all tests in Rust"""
    chosen = [options.k] if options.k else []
    command = ["cargo", "test", "--workspace"]
    programs = test_programs(command)
    tests = [(program, directory, *chosen, "--quiet") for program, directory in programs]
    # The examples in the documentation are compiled once more, by one core.
    tests.insert(1, (command[0], ROOT, *command[1:], "--doc", *chosen, "--", "--quiet"))
    if options.all:
        # The only tests of this library that the programs leave out by themselves: a search of minutes.
        washout = next(one for one in programs if named(one[0]) == "moris_washout")
        tests.insert(1, (*washout, *chosen, "--quiet", "--ignored"))
    # Side by side, and one more than cores: the longest waits for sockets and clocks.
    with ThreadPoolExecutor(usable_cores() + 1) as pool:
        failed = [output for output in pool.map(lambda test: failure(*test, **cases(options)), tests) if output]
    if failed:
        sys.exit("\n".join(failed))


@lru_cache(maxsize=None)
def examples():
    """Programs that the tests in Python call: the best possible ride, and reports."""
    run("cargo", "build", "--workspace", "--example", "bound", "--example", "pages")
    for example in ("bound", "pages"):
        os.environ[f"MORIS_{example.upper()}"] = str(TARGET / "debug" / "examples" / (example + PROGRAM))


def program(options):
    """Compiles the commands for tests that start them, so that none waits for cargo while others compile."""
    run("cargo", "build", "--bin", "moris", "--bin", "moris-live")
    os.environ["MORIS"] = str(TARGET / "debug" / ("moris" + PROGRAM))


def python_tests(options):
    """tests of the FMUs by FMPy, of their libraries, of the prose and the book"""
    examples()
    program(options)
    pytest(options, 2, "--dist", "loadfile", "tests/python", "--ignore", "tests/python/test_docs.py")


def docs(options):
    """commands of the pages, run as they are printed"""
    pytest(options, 2, "--dist", "load", "--maxschedchunk", "1", "tests/python/test_docs.py")


def install_package(optimised):
    """Optimised as users get it, or compiled as the tests are."""
    profile = {} if optimised else {"MATURIN_PEP517_ARGS": "--profile dev --features as-tested"}
    interpreter = python()
    install = [interpreter, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    builder = re.search(r'^requires = \["(.+)"\]', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[1]
    # Kept in the environment, where pip would download it for each build: a second run needs no network.
    run(*install, builder)
    run(*install, "--no-build-isolation", ".", PATH=f"{interpreter.parent}{os.pathsep}{os.environ['PATH']}", **profile)


def package(options):
    """the Python package: built, installed and tested"""
    pytest(options, 1, "--dist", "loadfile", "tests/python_package")


def passed_on(options, *names):
    return [f"--{name}" for name in names if getattr(options, name)]


def script(options, file, *names):
    run(sys.executable, file, *passed_on(options, *names), at_once=options.beside, are_tests=True)


def importers(options):
    """the FMUs in other people's simulation tools"""
    script(options, "tests/importers/run.py", "require")


def platforms(options):
    """the libraries for Windows and Arm, under Wine and qemu"""
    script(options, "tests/platforms/run.py", "install", "require")


def sources(options):
    """the sources in the washout's FMUs, compiled by C compilers"""
    script(options, "tests/sources/run.py", "install", "require")


def pages(options):
    """the reports in Chromium and Firefox"""
    examples()
    program(options)
    script(options, "tests/report/run.py", "install", "require")


def reproducible(options):
    """FMUs built in another directory, byte by byte"""
    script(options, "tests/reproducible.py")


def in_python(options, names):
    """Makes what these parts need, and runs them side by side: each waits for clocks, or for the longest of its tests alone."""
    python()
    with ThreadPoolExecutor() as pool:
        # The longest first, of those that need the package.
        installed = pool.submit(install_package, options.all) if {"package", "docs"} & set(names) else None
        running = [pool.submit(PARTS[name], options) for name in names if name == "python"]
        if installed:
            installed.result()
        running += [pool.submit(PARTS[name], options) for name in reversed(names) if name != "python"]
        for done in running:
            done.result()


def elsewhere(options, names):
    """Runs these parts in two rows side by side: browsers and emulators wait, where compilers work."""

    def row(*parts):
        for name in parts:
            if name in names:
                PARTS[name](options)

    with ThreadPoolExecutor() as pool:
        others = [pool.submit(row, "importers")]
        # Those that install something come after each other. The last compares libraries that the first makes.
        row("platforms")
        others.append(pool.submit(row, "reproducible"))
        row("sources", "pages")
        for done in others:
            done.result()


def alone(options, names):
    PARTS[names[0]](options)


DEFAULT = {"fmu": fmu, "rust": rust, "python": python_tests, "package": package, "docs": docs}
PARTS = {**DEFAULT, "importers": importers, "platforms": platforms, "sources": sources, "pages": pages, "reproducible": reproducible}
GROUPS = [
    (["fmu"], alone),
    (["rust"], alone),
    (["python", "package", "docs"], in_python),
    (["importers", "platforms", "sources", "pages", "reproducible"], elsewhere),
]


def processor_time():
    """Of the processes that have ended, in seconds; none where the system does not tell."""
    if os.name == "nt":
        return 0.0
    times = os.times()
    return times.children_user + times.children_system


def main():
    described = "\n".join(f"  {name:10} {part.__doc__}{'' if name in DEFAULT else ' (--all)'}" for name, part in PARTS.items())
    parser = argparse.ArgumentParser(
        description=f"Runs the tests. The parts:\n{described}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--all", action="store_true", help="every part, in all cases, with the optimised package")
    parser.add_argument("--only", action="append", choices=PARTS, metavar="PART", help="this part, with the FMUs as they are")
    parser.add_argument("-k", metavar="EXPRESSION", help="the tests that match, as pytest and cargo test understand it")
    parser.add_argument("--require", action="store_true", help="what other platforms and the pages need must be there")
    parser.add_argument("--install", action="store_true", help="install it first, with apt, rustup and pip")
    options = parser.parse_args()
    refused = list(refusals())
    if refused:
        sys.exit("\n".join(refused))
    chosen = options.only or (PARTS if options.all else DEFAULT)
    took = []
    if options.install and "pages" in chosen:
        # Before the command is compiled: it holds the pages' modules.
        add_rust_targets(WEBASSEMBLY)
    if options.install and options.all and "python" in chosen:
        install_mdbook()
    if options.install and options.all and "package" in chosen:
        add_rust_targets(*BOARD_TARGETS)
        install_packages(*BOARD_TOOLS)
    # Otherwise the tests change no toolchain.
    os.environ["RUSTUP_AUTO_INSTALL"] = "0"
    if not options.all:
        # Optimising the FMUs' libraries as a whole takes a third of their compilation.
        os.environ |= {"CARGO_PROFILE_FMU_LIBRARY_LTO": "off", "CARGO_PROFILE_FMU_LIBRARY_CODEGEN_UNITS": "16"}
    for together, run_together in GROUPS:
        names = [name for name in together if name in chosen]
        if not names:
            continue
        start, used = time.monotonic(), processor_time()
        options.beside = len(names) > 1
        run_together(options, names)
        took.append(f"{time.monotonic() - start:8.0f}{processor_time() - used:16.0f}  {', '.join(names)}")
    print(" seconds  processor time  part", *took, sep="\n")
    print("No test has failed.")
    if lacking:
        print("Not run, because something is missing here:", *dict.fromkeys(lacking), sep="\n  ")


if __name__ == "__main__":
    main()
