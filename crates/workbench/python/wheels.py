"""Builds wheels of the Python package for several platforms into target/wheels.

    python3 crates/workbench/python/wheels.py [PLATFORM...]

Needs maturin and zig (`pip install maturin ziglang`), mingw for Windows (`apt install gcc-mingw-w64-x86-64`), and the targets
that it names where one is missing (`rustup target add TARGET`). For macOS, SDKROOT names Apple's development kit.
`tests/python_package/try_wheel.py` tries a wheel.
"""

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
ZIG = ["--zig", "--compatibility", "manylinux2014"]
PLATFORMS = {
    "linux-x86_64": ["--target", "x86_64-unknown-linux-gnu", *ZIG],
    "linux-aarch64": ["--target", "aarch64-unknown-linux-gnu", *ZIG],
    "windows-x86_64": ["--target", "x86_64-pc-windows-gnu"],
    "macos-x86_64": ["--target", "x86_64-apple-darwin", "--zig"],
    "macos-aarch64": ["--target", "aarch64-apple-darwin", "--zig"],
}


def main():
    parser = argparse.ArgumentParser(description="Builds wheels of the Python package.")
    parser.add_argument("platforms", nargs="*", metavar="PLATFORM", help=f"of {', '.join(PLATFORMS)} [default: all]")
    chosen = parser.parse_args().platforms or list(PLATFORMS)
    unknown = [platform for platform in chosen if platform not in PLATFORMS]
    if unknown:
        parser.error(f"there is no platform {unknown[0]}; there are {', '.join(PLATFORMS)}")
    failed = []
    for platform in chosen:
        command = [sys.executable, "-m", "maturin", "build", "--release", "--out", "target/wheels", *PLATFORMS[platform]]
        print("$", *command, flush=True)
        if subprocess.run(command, cwd=ROOT).returncode != 0:
            failed.append(platform)
    if failed:
        sys.exit(f"not built: {', '.join(failed)}")


if __name__ == "__main__":
    main()
