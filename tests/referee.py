#!/usr/bin/env python3
"""Freezes what the workbench says and writes, so that two builds can be compared: for a change that may change nothing.

    python3 tests/referee.py freeze before.json --moris FILE [--commands FILE] RECORDINGS...
    python3 tests/referee.py freeze after.json --moris FILE [--commands FILE] RECORDINGS...
    python3 tests/referee.py compare before.json after.json

RECORDINGS are files, or folders of them: each is simulated and measured. A line of --commands is a further command, as a
JSON object with the folder "cwd" and the list "args". Of each command the exit status, the text and the JSON are kept, and of
each file that it writes a hash. Of a table each column has its own: those of the vehicle are the inputs. `compare` prints
what differs by kind and has the exit status 1 if anything but text does.
"""

import argparse
import csv
import difflib
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

RECORDING_SUFFIXES = {".csv", ".txt", ".tsv", ".vbo"}
RECORDING_COMMANDS = [["simulate", "{recording}", "--no-bound", "--json", "--report", "{out}"], ["measure", "{recording}"]]
COMMANDS = [
    *(["parameters", name] for name in ("default", "classical", "adaptive", "optimal", "robust")),
    ["schema", "simulation"],
    *(["schema", name] for name in ("rig", "parameters", "conventions")),
    *([name, "--help"] for name in ("simulate", "measure", "fit", "bench", "tune", "rig", "build-fmu")),
]


def digest(content):
    return hashlib.sha256(content).hexdigest()[:16]


def column_digests(file):
    """The hash of each column of a table, by its title."""
    rows = list(csv.reader(file.read_text().splitlines()))
    return {title: digest("\n".join(column).encode()) for title, *column in zip(*rows, strict=False)}


def run(moris, args, cwd=None):
    """What a command says and writes into the folder that replaces {out} in its arguments."""
    with tempfile.TemporaryDirectory() as folder:
        args = [argument.replace("{out}", folder) for argument in args]
        done = subprocess.run([moris, *args], cwd=cwd or folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        said, noted = (text.replace(folder, "{out}") for text in (done.stdout, done.stderr))
        result = {"status": done.returncode, "text": said + noted}
        if said.startswith(("[", "{")):
            result["json"] = json.loads(said)
        for file in sorted(path for path in Path(folder).rglob("*") if path.is_file()):
            name = str(file.relative_to(folder))
            tables = column_digests(file) if name.endswith(".csv") else {"": digest(file.read_bytes().replace(folder.encode(), b"{out}"))}
            result |= {f"file {name} {column}": value for column, value in tables.items()}
        return result


def commands(options):
    """Every command as its folder and its arguments."""
    yield from ((None, args) for args in COMMANDS)
    for place in options.recordings:
        for file in sorted(place.iterdir()) if place.is_dir() else [place]:
            if file.suffix in RECORDING_SUFFIXES:
                for args in RECORDING_COMMANDS:
                    yield None, [argument.replace("{recording}", str(file.resolve())) for argument in args]
    for line in options.commands.read_text().splitlines() if options.commands else []:
        command = json.loads(line)
        yield command["cwd"], command["args"]


def freeze(options):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        tasks = {json.dumps([cwd, args]): (cwd, args) for cwd, args in commands(options)}
        results = pool.map(lambda task: run(options.moris, task[1], task[0]), tasks.values())
        options.file.write_text(json.dumps(dict(zip(tasks, results, strict=True)), indent=1))
    print(f"{len(tasks)} commands")


def kind(key):
    if key.startswith("file "):
        column = key.split(" ", 2)[2]
        return "inputs" if column.startswith("vehicle.") else "outputs" if column else "files"
    return key


def compare(options):
    before, after = (json.loads(file.read_text()) for file in (options.file, options.other))
    differences = {}
    for command in before.keys() | after.keys():
        old, new = before.get(command, {}), after.get(command, {})
        for key in old.keys() | new.keys():
            if old.get(key) != new.get(key):
                differences.setdefault(kind(key), {}).setdefault(command, []).append(key)
    for name, found in sorted(differences.items()):
        print(f"{name}: differ in {len(found)} of {len(before)} commands")
        for command, keys in sorted(found.items()):
            print("  " + command, ", ".join(sorted(keys))[:100])
            if name == "text":
                texts = [frozen.get(command, {}).get("text", "").splitlines() for frozen in (before, after)]
                print("\n".join(f"      {line}"[:200] for line in difflib.unified_diff(*texts, n=0, lineterm="") if line[:3] not in ("---", "+++")))
    return 1 if differences.keys() - {"text"} else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = parser.add_subparsers(required=True)
    part = parts.add_parser("freeze")
    part.set_defaults(act=freeze)
    part.add_argument("file", type=Path)
    part.add_argument("--moris", required=True)
    part.add_argument("--commands", type=Path)
    part.add_argument("recordings", type=Path, nargs="+")
    part = parts.add_parser("compare")
    part.set_defaults(act=compare)
    part.add_argument("file", type=Path)
    part.add_argument("other", type=Path)
    options = parser.parse_args()
    sys.exit(options.act(options))


if __name__ == "__main__":
    main()
