#!/usr/bin/env python3
"""Makes the files of a release into target/dist, tries them outside the sources, and writes notes and checksums.

    python3 .ci/release.py [--only PART ...] [--platform PLATFORMS] [--output DIRECTORY] [--profile PROFILE]

Each part can be made on a machine of its own; notes and checksums come last.
"""

import argparse
import hashlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile
from pathlib import Path

from sbom import bill_of_materials

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ".exe" if os.name == "nt" else ""
MATURIN = "maturin>=1.9,<2"
FMPY = "fmpy==0.3.32"
# Packages that others can use without this repository. The rest reads files of the workspace, or is a tool of it.
CRATES = ["moris-interface", "moris-washout", "moris-fmi", "moris-simulation", "moris-motorcycle", "moris-stewart-platform", "moris-laps", "moris-live"]
CHECKSUMS = "SHA256SUMS"
CYCLONEDX = "cyclonedx-python-lib[json-validation]==11.12.0"
VALIDATION = """
import pathlib, sys
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
sys.exit(JsonStrictValidator(SchemaVersion.V1_5).validate_str(pathlib.Path(sys.argv[1]).read_text()))
"""


def run(*command, cwd=ROOT, **options):
    print("$", *command, flush=True)
    return subprocess.run([str(part) for part in command], cwd=cwd, check=True, **options)


def environment(directory, *packages, variables=None):
    """The interpreter of a new virtual environment with these packages."""
    venv.create(directory, with_pip=True)
    python = directory / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages, env=variables)
    return python


def private_paths(root=ROOT):
    """Directories that a program must not show, and the names in their place."""
    printed = subprocess.run(["rustc", "--print", "sysroot"], check=True, capture_output=True, text=True).stdout.strip()
    cargo = Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))
    return {root: "workspace", Path(printed, "lib", "rustlib", "src", "rust"): "rust", cargo: "cargo"}


def without_paths(root=ROOT):
    """The environment in which cargo makes a program of the same bytes in any directory."""
    flags = (f"--remap-path-prefix={path}={name}" for path, name in private_paths(root).items())
    return os.environ | {"CARGO_ENCODED_RUSTFLAGS": "\x1f".join(flags)}


def version():
    return re.search(r'^version = "(.+)"', (ROOT / "Cargo.toml").read_text(), re.MULTILINE)[1]


def fmus(options):
    """FMUs of all models and versions of FMI; FMPy simulates each"""
    where = ["--output", options.output, *(["--platform", options.platform] if options.platform else [])]
    run("cargo", "build-fmu", "--fmi", "2,3", *where)
    run("cargo", "build-fmu", "--fmi", "3", "--arrays", *where)
    run("cargo", "build-fmu", "--reals-only", *where)
    with tempfile.TemporaryDirectory() as folder:
        python = environment(Path(folder) / "venv", FMPY)
        for fmu in sorted(options.output.glob("*.fmu")):
            code = f"import fmpy; print(len(fmpy.simulate_fmu({str(fmu)!r}, stop_time=1)))"
            run(python, "-c", code, cwd=folder)


def systems(options):
    """packages of the simulator (SSP)"""
    where = ["--output", options.output, *(["--platform", options.platform] if options.platform else [])]
    for system in ("MotorcycleSimulator", "MotorcycleLap"):
        for form in ([], ["--flat"]):
            run("cargo", "build-ssp", "--system", system, *form, *where)


def packed_program(options, target):
    """The commands for this machine, or for a target of Rust, in an archive."""
    targeted = ["--target", target] if target else []
    run("cargo", "build", "--locked", "--package", "moris", "--package", "moris-live-command", "--profile", options.profile, *targeted, env=without_paths())
    directory = ROOT / "target" / (target or "") / ("debug" if options.profile == "dev" else options.profile)
    suffix = ".exe" if target and "windows" in target else PROGRAM
    built = [directory / f"{name}{suffix}" for name in ("moris", "moris-live")]
    for program in built:
        shown = [str(path) for path in private_paths() if str(path).encode() in program.read_bytes()]
        assert not shown, f"{program} shows the paths {shown}"
    system = {"Darwin": "macos"}.get(platform.system(), platform.system().lower())
    packed = options.output / f"moris-{version()}-{target or f'{system}-{platform.machine().lower()}'}.zip"
    with zipfile.ZipFile(packed, "w") as archive:
        for file in (*built, *(ROOT / name for name in ("LICENSE-MIT", "LICENSE-APACHE", "README.md"))):
            # Neither the time nor the permissions of this machine.
            entry = zipfile.ZipInfo(file.name)
            entry.create_system, entry.external_attr = 3, (0o755 if file in built else 0o644) << 16
            archive.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)
    return packed


def program(options):
    """the command moris for this machine and for --target; this machine's simulates a ride and makes an own FMU"""
    for target in options.target:
        packed_program(options, target)
    packed = packed_program(options, None)
    with tempfile.TemporaryDirectory() as folder:
        shutil.unpack_archive(packed, folder)
        moris = Path(folder) / f"moris{PROGRAM}"
        # Unpacking by Python drops the permission to execute.
        moris.chmod(0o755)
        run(sys.executable, ROOT / "examples" / "recording.py", "ride.csv", cwd=folder)
        run(moris, "simulate", "ride.csv", cwd=folder)
        base = options.output / "MorisWashout.fmu"
        if base.exists():
            run(moris, "build-fmu", "--base", base, "--parameters", "classical", cwd=folder)


def wheel(options):
    """the Python package, as a wheel for this machine and as sources; both simulate"""
    with tempfile.TemporaryDirectory() as folder:
        maturin = environment(Path(folder) / "maturin", MATURIN)
        made = Path(folder) / "made"
        run(maturin, "-m", "maturin", "build", "--locked", "--profile", options.profile, "--out", made, env=without_paths())
        run(maturin, "-m", "maturin", "sdist", "--out", made)
        shutil.copy(ROOT / "tests" / "python_package" / "try_wheel.py", folder)
        # The sources may lack a file that the working tree has: they are compiled, too.
        compiled = os.environ | {"CARGO_TARGET_DIR": str(ROOT / "target" / "sdist"), "MATURIN_PEP517_ARGS": f"--profile {options.profile}"}
        for file in sorted(made.iterdir()):
            python = environment(Path(folder) / f"clean-{file.suffix[1:]}", file, variables=compiled)
            run(python, "try_wheel.py", cwd=folder)
        for file in made.iterdir():
            shutil.copy(file, options.output)


def crates(options):
    """the packages for other people's Rust programs, compiled from what is packed"""
    chosen = [argument for crate in CRATES for argument in ("--package", crate)]
    run("cargo", "package", "--locked", *chosen)
    for crate in CRATES:
        shutil.copy(ROOT / "target" / "package" / f"{crate}-{version()}.crate", options.output)


def sbom(options):
    """the bill of materials: every package that is compiled into what is released"""
    libraries = [f"moris-{folder.name}" for folder in sorted((ROOT / "crates" / "fmus").iterdir())]
    released = [*CRATES, *libraries, "moris", "moris-python"]
    bill = bill_of_materials("moris", version(), released)
    file = options.output / f"moris-{version()}.cdx.json"
    file.write_text(json.dumps(bill, indent=1) + "\n", encoding="utf-8", newline="\n")
    with tempfile.TemporaryDirectory() as folder:
        python = environment(Path(folder) / "venv", CYCLONEDX)
        run(python, "-c", VALIDATION, file, cwd=folder)


def notes(options):
    """the version's section of CHANGELOG.md, or what is unreleased"""
    sections = re.split(r"^## (.+)$\n", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    of_heading = dict(zip(sections[::2], sections[1::2]))
    heading = next((heading for heading in of_heading if version() in heading), "Unreleased")
    text = of_heading[heading].strip()
    (options.output / "NOTES.md").write_text(f"# {heading}\n\n{text}\n", encoding="utf-8")


def checksums(options):
    """SHA-256 of every file"""
    files = sorted(file for file in options.output.iterdir() if file.is_file() and file.name != CHECKSUMS)
    lines = [f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in files]
    (options.output / CHECKSUMS).write_text("".join(lines), encoding="utf-8", newline="\n")


PARTS = {part.__name__: part for part in (fmus, systems, program, wheel, crates, sbom, notes, checksums)}


def main():
    described = "\n".join(f"  {name:10} {part.__doc__}" for name, part in PARTS.items())
    parser = argparse.ArgumentParser(
        description=f"{__doc__.splitlines()[0]} The parts:\n{described}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", action="append", choices=PARTS, metavar="PART", help="this part [default: all]")
    parser.add_argument("--platform", help="platforms of FMUs and systems, as of cargo build-fmu [default: this machine's]")
    parser.add_argument("--target", action="append", default=[], help="a target of Rust for which the program is made, too; not tried")
    parser.add_argument("--output", type=Path, default=ROOT / "target" / "dist", help="[default: target/dist]")
    parser.add_argument("--profile", default="release", help="of the program and the wheel; dev for a rehearsal [default: release]")
    options = parser.parse_args()
    options.output = options.output.resolve()
    options.output.mkdir(parents=True, exist_ok=True)
    for name, part in PARTS.items():
        if not options.only or name in options.only:
            part(options)


if __name__ == "__main__":
    main()
