"""The washout on emulated microcontrollers: outputs equal to the PC's to the bit."""

import os
import shutil
import struct
import subprocess
from pathlib import Path

import moris
import numpy as np
import pytest
from conftest import ROOT, TARGET, only_all_cases

# Board of QEMU -> its Rust target and flags: with a processor of double precision, and with one of none.
BOARDS = {"mps2-an500": ("thumbv7em-none-eabihf", "-C target-cpu=cortex-m7"), "mps2-an385": ("thumbv7m-none-eabi", "")}
SETS = ["classical", "adaptive", "optimal", "robust", "predictive", "preview", "paper"]
STEP = 0.001
MAX_SECONDS = 600
"""For a build or a run that hangs."""

pytestmark = only_all_cases


def cargo(board, *arguments):
    """Calls cargo for a board's target."""
    target, flags = BOARDS[board]
    sysroot = subprocess.run(["rustc", "--print", "sysroot"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    if not (Path(sysroot) / "lib" / "rustlib" / target).exists():
        pytest.skip(f"needs Rust for {target}: rustup target add {target}")
    flags = {f"CARGO_TARGET_{target.upper().replace('-', '_')}_RUSTFLAGS": flags}
    command = ["cargo", *arguments, "--quiet", "--profile", "fmu-library", "--target", target]
    subprocess.run(command, cwd=ROOT, env=os.environ | flags, check=True, timeout=MAX_SECONDS)
    return Path(TARGET) / target / "fmu-library"


def needs(program, package):
    if not shutil.which(program):
        pytest.skip(f"needs {program}: apt-get install {package}")


def emulator(board, program):
    """QEMU's command. An instruction takes 1 ns of the board's time."""
    needs("qemu-system-arm", "qemu-system-arm")
    command = ["qemu-system-arm", "-M", board, "-nographic", "-monitor", "none", "-icount", "shift=0", "-kernel", program]
    return [*command, "-semihosting-config", "enable=on,target=native"]


def drive(count):
    """Braking at its end, a slalom, bumps: specific force, angular velocity, orientation, speed and lean a row."""
    time = STEP * np.arange(count)
    roll = 0.3 * np.sin(2.1 * time)
    columns = [
        3.0 * np.sin(0.9 * time) - np.where(time > 0.4, 5.0, 0.0),
        4.0 * np.sin(2.1 * time) * np.cos(0.3 * time),
        9.80665 + 1.5 * np.sin(21.0 * time),
        0.63 * np.cos(2.1 * time),
        0.065 * np.cos(1.3 * time),
        0.6 + 0 * time,
        roll,
        0.05 * np.sin(1.3 * time),
        0.6 * time,
        20.0 - 5.0 * time,
        0.1 * np.sin(time),
    ]
    return np.column_stack(columns)


def hash_of_outputs(parameters, rows):
    """FNV-1a of the bits of all outputs at all rows, on this machine."""
    washout, result = moris.Washout(parameters=parameters), 0xCBF29CE484222325
    for k, row in enumerate(rows):
        ahead = rows[k + 200 :: 200][:20, :2]
        preview = ahead if len(ahead) else None
        output = washout.step(STEP, row[:3], row[3:6], row[6:9], row[9], row[10], preview=preview, preview_step=0.2)
        for (bits,) in struct.iter_unpack("<Q", np.array(list(output.values()), dtype="<f8").tobytes()):
            result = (result ^ bits) * 0x100000001B3 % 2**64
    return f"{result:016x}"


@pytest.mark.parametrize(("board", "count"), [("mps2-an500", 800), ("mps2-an385", 100)])
def test_the_outputs_of_all_strategies_are_those_of_the_pc_to_the_bit(board, count, tmp_path):
    packages = ["--package", "moris-board-tests", "--package", "moris-laps"]
    program = cargo(board, "build", "--no-default-features", *packages) / "moris-board-tests"
    rows = drive(count)
    (tmp_path / "drive.bin").write_bytes(struct.pack("<d", STEP) + rows.astype("<f8").tobytes())
    command = [*emulator(board, program), "-serial", "none"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=MAX_SECONDS)
    print(done.stderr)
    assert done.returncode == 0, done.stderr
    hashes = dict(line.split() for line in done.stderr.splitlines() if not line.startswith("#"))
    assert hashes == {name: hash_of_outputs(name, rows) for name in SETS}
