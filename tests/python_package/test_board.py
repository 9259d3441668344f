"""The washout on emulated microcontrollers: outputs equal to the PC's to the bit."""

import os
import re
import shutil
import struct
import subprocess
from pathlib import Path

import moris
import numpy as np
import pytest
from conftest import ROOT, STANDARD_GRAVITY, TARGET, only_all_cases

# Board of QEMU -> its Rust target: with a processor of double precision, and with one of none.
BOARDS = {"mps2-an500": "thumbv7em-none-eabihf", "mps2-an385": "thumbv7m-none-eabi"}
CORTEX_M7 = ["-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-d16"]
C_FLAGS = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-ffreestanding", "-nostdlib"]
C_FLAGS += ["-Wl,--gc-sections,-z,noexecstack,--fatal-warnings"]
EXAMPLE = ROOT / "examples" / "board"
MORIS = [os.environ["MORIS"]] if "MORIS" in os.environ else ["cargo", "run", "--quiet", "--bin", "moris", "--"]
MAX_FRAMES = 3000
"""Of the example: a minute at 50 Hz."""
SETS = ["classical", "adaptive", "optimal", "robust", "default", "preview", "paper"]
STEP = 0.001
PREVIEWED_ROWS = 4000
"""At the end of a drive: a preview has 20 elements, 0.2 s apart."""
BUFFER_SIZES = {"classical": 24 << 10, "predictive": 240 << 10}
MAX_FLASH = 300_000
MAX_INSTRUCTIONS = {"classical": 50_000, "default": 150_000, "preview": 380_000}
"""Of a step of 1 ms of the drive, on the Cortex-M7."""
MAX_STACKS = {"classical": (66_000, 18_000), "default": (136_000, 18_000)}
"""Bytes to make a washout and to step it, on the Cortex-M7."""
MAX_SECONDS = 600
"""For a build or a run that hangs."""

pytestmark = only_all_cases


def cargo(target, *arguments):
    """Calls cargo for a target; returns the folder of what it makes."""
    sysroot = subprocess.run(["rustc", "--print", "sysroot"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    if not (Path(sysroot) / "lib" / "rustlib" / target).exists():
        pytest.skip(f"needs Rust for {target}: rustup target add {target}")
    subprocess.run(["cargo", *arguments], cwd=ROOT, check=True, timeout=MAX_SECONDS)
    return Path(TARGET) / target / "board"


def needs(program, package):
    if not shutil.which(program):
        pytest.skip(f"needs {program}: apt-get install {package}")


def emulator(board, program, shift, *options):
    """QEMU's command. An instruction takes 2 to the power of `shift` ns of the board's time."""
    needs("qemu-system-arm", "qemu-system-arm")
    return ["qemu-system-arm", "-M", board, "-nographic", "-monitor", "none", "-icount", f"shift={shift}", "-kernel", program, *options]


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
    """FNV-1a of the bits of all outputs at all rows but those that are previewed alone, on this machine."""
    washout, result = moris.Washout(parameters=parameters), 0xCBF29CE484222325
    for k, row in enumerate(rows[:-PREVIEWED_ROWS]):
        preview = rows[k + 200 :: 200][:20, :2] if parameters == "preview" else None
        output = washout.step(STEP, row[:3], row[3:6], row[6:9], row[9], row[10], preview=preview, preview_step=0.2)
        for (bits,) in struct.iter_unpack("<Q", np.array(list(output.values()), dtype="<f8").tobytes()):
            result = (result ^ bits) * 0x100000001B3 % 2**64
    return f"{result:016x}"


@pytest.mark.parametrize(("board", "count"), [("mps2-an500", 800), ("mps2-an385", 100)])
def test_the_outputs_of_all_strategies_are_those_of_the_pc_to_the_bit(board, count, tmp_path):
    built = ["--quiet", "--profile", "board", "--target", BOARDS[board]]
    program = cargo(BOARDS[board], "build", "--package", "moris-board-tests", *built) / "moris-board-tests"
    cargo(BOARDS[board], "build", "--package", "moris-laps", "--no-default-features", *built)
    rows = drive(count + PREVIEWED_ROWS)
    (tmp_path / "drive.bin").write_bytes(struct.pack("<d", STEP) + rows.astype("<f8").tobytes())
    command = emulator(board, program, 0, "-serial", "none", "-semihosting-config", "enable=on,target=native")
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=MAX_SECONDS)
    print(done.stderr)
    assert done.returncode == 0, done.stderr
    hashes = dict(line.split() for line in done.stderr.splitlines() if not line.startswith("#"))
    assert hashes == {name: hash_of_outputs(name, rows) for name in SETS}
    if board == "mps2-an500":
        # "# classical: instructions a step 26600 mean 54000 most, buffer 14468 B, stack 76068 B to make 14576 B to step"
        figures = {line[2:].split(":")[0]: [int(n) for n in re.findall(r" (\d+) ", line)] for line in done.stderr.splitlines() if line[0] == "#"}
        for name, most in MAX_INSTRUCTIONS.items():
            assert figures[name][1] <= most, f"{name}: {figures[name][1]} instructions in a step, at most {most}"
        for name, most in MAX_STACKS.items():
            assert np.all(np.less_equal(figures[name][3:], most)), f"{name}: stacks of {figures[name][3:]} B, at most {most}"


def example(folder, strategy, parameters, rig="default"):
    """The example in C with the library of one strategy, with a parameter set and a rig."""
    needs("arm-none-eabi-gcc", "gcc-arm-none-eabi")
    library = cargo("thumbv7em-none-eabihf", "build-board", strategy, "--quiet") / "libmoris_board.a"
    command = [*MORIS, "parameters", "--parameters", parameters, "--rig", rig, "--c-header"]
    (folder / "moris_parameters.h").write_bytes(subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout)
    sources = [EXAMPLE / "platform.c", EXAMPLE / "mps2.c", library, "-lgcc", "-T", EXAMPLE / "mps2.ld"]
    include = ["-I", ROOT / "crates" / "board" / "include", "-I", folder, f"-DBUFFER_SIZE={BUFFER_SIZES[strategy]}"]
    program = folder / f"{strategy}.elf"
    subprocess.run(["arm-none-eabi-gcc", *CORTEX_M7, *C_FLAGS, *include, *sources, "-o", program], check=True)
    return program


@pytest.mark.parametrize(("strategy", "parameters"), [("classical", "classical"), ("predictive", "default")])
def test_a_program_in_c_with_one_strategy_has_at_most_300_kb_of_code_and_constants(strategy, parameters, tmp_path):
    program = example(tmp_path, strategy, parameters)
    printed = subprocess.run(["arm-none-eabi-size", program], capture_output=True, text=True, check=True).stdout
    text, data = map(int, printed.splitlines()[1].split()[:2])
    assert 100_000 < text + data <= MAX_FLASH, printed


def test_a_strategy_that_is_not_built_in_is_refused_with_the_remedy(tmp_path):
    command = emulator("mps2-an500", example(tmp_path, "classical", "default"), 4, "-serial", "stdio")
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as board:
        try:
            assert board.stdout.readline() == "strategy: is predictive, which is not built in; build with the feature predictive\n"
        finally:
            board.kill()


ARDUINO = """
#include <stdint.h>
#define DMAMEM __attribute__((section(".dmabuffers"), used))
extern struct SerialLine { void begin(uint32_t); int read(); void print(const char *); } Serial;
extern "C" { uint32_t millis(void); void analogWrite(uint8_t, int); uint32_t analogWriteResolution(uint32_t); void analogWriteFrequency(uint8_t, float); }
"""
"""What the example for a Teensy uses of its core, as that declares it."""


def test_the_example_for_a_teensy_has_all_functions_of_a_board(tmp_path):
    needs("arm-none-eabi-g++", "gcc-arm-none-eabi")
    (tmp_path / "Arduino.h").write_text(ARDUINO)
    flags = [*CORTEX_M7, *(flag for flag in C_FLAGS if flag != "-std=c99"), "-std=gnu++17", "-I", tmp_path]
    made = tmp_path / "teensy.o"
    subprocess.run(["arm-none-eabi-g++", *flags, "-c", EXAMPLE / "teensy.cpp", "-o", made], check=True)

    def symbols(kind):
        return subprocess.run(["arm-none-eabi-nm", kind, made], capture_output=True, text=True, check=True).stdout.split()

    board = set(re.findall(r"\bboard_\w+(?=[(\[])", (EXAMPLE / "board.h").read_text()))
    assert len(board) == 5 and board <= set(symbols("--defined-only"))
    assert "run_platform" in symbols("--undefined-only")


MIRRORED = np.array([1, -1, 1, -1, 1, -1])
"""The servos of the example whose longer pulse raises the arm, and those mounted the other way round."""
ACTUATORS = {
    "default": ("length", lambda length: 1000 + 1000 * (length - 1.0) / 0.6, np.full(6, 1.0), 39),
    str(ROOT / "examples" / "rigs" / "crank-servo.toml"): ("angle", lambda angle: 1500 + MIRRORED * 2000 / np.pi * angle, np.full(6, np.radians(-80)), 98),
}
"""By rig: the output, its pulses [us], its lowest pose, and the most by which a pulse changes in a frame [us].

The legs' largest speed is 1 m/s, 33 us a frame, and the arms' 6 rad/s, 76 us. The way up adds 5 us, and 11 us an arm;
a frame may come a step late."""


@pytest.mark.parametrize("rig", list(ACTUATORS), ids=["legs", "cranks"])
def test_the_example_in_c_rises_cues_the_telemetry_and_parks_when_it_ends(rig, tmp_path):
    """A line follows each frame. Where this machine pauses, the platform may return early: it is only asked to arrive."""
    washout = moris.Washout(rig=rig, parameters="classical")
    for _ in range(40_000):
        settled = washout.step(STEP, [1.5, 0.0, STANDARD_GRAVITY], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0, 0.0)
    quantity, pulse, lowest, most = ACTUATORS[rig]
    cued = pulse(np.array([settled[f"actuator[{k}].{quantity}"] for k in range(1, 7)]))
    frames = []
    command = emulator("mps2-an500", example(tmp_path, "classical", "classical", rig), 5, "-serial", "stdio")
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1) as board:

        def next_frame():
            name, *pulses = board.stdout.readline().split()
            assert name == "P" and len(frames) < 2 * MAX_FRAMES
            frames.append([int(pulse) for pulse in pulses[:6]])
            return pulses[6:] == ["parked"]

        try:
            assert all(next_frame() for _ in range(5)), "it waits at the lowest pose"
            while not np.allclose(frames[-1], cued, atol=1):
                board.stdin.write("1.5,0,9.80665,0,0,0\n")
                next_frame()
            while not next_frame():
                pass
        finally:
            board.kill()
    assert np.allclose(frames[-1], pulse(lowest), atol=1)
    assert np.abs(np.diff(frames, axis=0)).max() <= most
