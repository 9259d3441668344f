#!/usr/bin/env python3
"""Looks at the FMU's memory with the address sanitizer and with valgrind, and prints a line each.

    python3 tests/memory/run.py [--require] [--fuzz SECONDS]

A tool that is not here is reported as missing; with --require that is a failure. --fuzz also runs the fuzzer of fuzz/ for
so long with each version of FMI (it needs cargo-fuzz).
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
HOST = "x86_64-unknown-linux-gnu"
PACKAGES = ["moris-fmi", "moris-washout-fmi2", "moris-fmu-tests"]
# Valgrind is fifty times slower: of the washout's tests those that call most in least time, by package and test program.
UNDER_VALGRIND = {
    ("moris-washout-fmi2", "abi"): [
        "rounds::a_few_rounds_do_no_harm",
        "washout::a_restored_state_repeats_bit_for_bit",
        "values::impossible_values_are_discarded_and_the_old_ones_stay",
    ],
    ("moris-fmu-tests", "models"): ["hostile::bytes_lead_the_host_too"],
}
# Fuzz targets: the hostile host by each version of FMI.
FUZZ_TARGETS = ["fmi2", "fmi3"]

# A test that lets the kernel kill whoever calls it; the sanitizer does.
CALLS_THE_SYSTEM_ITSELF = "no_set_step_or_get_calls_the_system"
# Tests of the hunter's own code, which calls no C function in them.
OF_THE_HUNTER = ["attacks", "command", "oracle", "search"]


class Missing(Exception):
    """The tool is not here."""


class Failed(Exception):
    """The tool found something; what it said."""


def run(command, **environment):
    """Runs a command; gives back what it printed."""
    process = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **environment}, text=True, errors="replace",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )
    if process.returncode != 0:
        raise Failed(f"{' '.join(map(str, command))}\n{process.stdout}")
    return process.stdout


def need_nightly():
    try:
        targets = run(["rustup", "run", "nightly", "rustc", "--print", "target-libdir", "--target", HOST])
    except (Failed, FileNotFoundError):
        raise Missing("no nightly toolchain: rustup toolchain install nightly") from None
    if not Path(targets.strip()).is_dir():
        raise Missing(f"nightly has no {HOST}")


def address_sanitizer():
    """All tests through the C ABI, hostile host and leak check included."""
    need_nightly()
    output = run(
        ["cargo", "+nightly", "test", "--target", HOST, *(f"--package={package}" for package in PACKAGES),
         "--", "--skip", CALLS_THE_SYSTEM_ITSELF, *(f"--skip={name}::" for name in OF_THE_HUNTER)],
        # The library finds the sanitizer in the test that loads it, which has to show it: -rdynamic.
        RUSTFLAGS="-Zsanitizer=address -Clink-arg=-rdynamic", ASAN_OPTIONS="detect_leaks=1",
        CARGO_TARGET_DIR=str(TARGET / "address-sanitizer"),
    )
    return f"{count_passed(output)} tests, no error and no leak"


def valgrind():
    """The washout's library in the tests' hands."""
    if shutil.which("valgrind") is None:
        raise Missing("apt install valgrind")
    passed = 0
    for (package, program), tests in UNDER_VALGRIND.items():
        output = run([
            "valgrind", "--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite,indirect",
            test_program(package, program), "--test-threads=1", "--exact", *tests,
        ])
        if count_passed(output) != len(tests):
            raise Failed(f"not all of {tests} ran:\n{output}")
        passed += len(tests)
    return f"{passed} tests, no error and no leak"


def test_program(package, name):
    """Builds a package's tests; returns the program of this name."""
    output = run(["cargo", "test", "-p", package, "--no-run", "--message-format=json"])
    lines = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
    (program,) = {
        line["executable"] for line in lines
        if line.get("executable") and line["target"]["kind"] == ["test"] and line["target"]["name"] == name
    }
    return program


def fuzzer(target, seconds):
    """The hostile host, led by what its calls reach, under the address sanitizer."""
    need_nightly()
    if shutil.which("cargo-fuzz") is None:
        raise Missing("cargo install cargo-fuzz")
    output = run(
        ["cargo", "+nightly", "fuzz", "run", target, "--", f"-max_total_time={seconds}", "-max_len=4096"],
        CARGO_TARGET_DIR=str(TARGET / "fuzz"),
    )
    runs = re.search(r"Done (\d+) runs in (\d+) second", output)
    if runs is None:
        raise Failed(output)
    return f"{runs[1]} sequences of calls in {runs[2]} s, no failure"


def count_passed(output):
    return sum(int(count) for count in re.findall(r"^test result: ok\. (\d+) passed", output, re.MULTILINE))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--require", action="store_true", help="a missing tool is a failure")
    parser.add_argument("--fuzz", type=int, metavar="SECONDS", help="also run each fuzzer for so long")
    options = parser.parse_args()
    checks = [("address sanitizer", address_sanitizer), ("valgrind", valgrind)]
    if options.fuzz:
        checks += [(f"fuzzer, {target}", lambda target=target: fuzzer(target, options.fuzz)) for target in FUZZ_TARGETS]
    bad = False
    for name, check in checks:
        try:
            print(f"{name}: ok ({check()})", flush=True)
        except Missing as reason:
            bad |= options.require
            print(f"{name}: missing ({reason})", flush=True)
        except Failed as failure:
            bad = True
            print(f"{name}: FAILED\n{failure}", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
