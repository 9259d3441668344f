"""What a step of the kernel is made of: the instructions of `benches/programs/steps.rs`, by kind, as callgrind counts them.

    python3 benches/operations.py            # the default parameters
    python3 benches/operations.py classical  # another ride of `benches/programs/steps.rs`

Needs valgrind and objdump, and an x86-64 machine. The figures do not depend on what else the machine does.
"""

import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
SHORT, LONG = 1_000, 11_000

# Mnemonics, from the most special to the most general. `pd` is two numbers at once, `sd` one.
KINDS = [
    ("divisions and roots, two at once", r"(div|sqrt)pd"),
    ("divisions and roots", r"(div|sqrt)sd"),
    ("additions and multiplications, two at once", r"(add|sub|mul)pd"),
    ("additions and multiplications", r"(add|sub|mul)sd"),
    ("comparisons, signs, smaller and larger", r"(u?comi|cmp\w*|min|max|and|andn|or|xor)[ps]d|xorps|orps|andps|p(and|or|xor)\w*|movmskp\w"),
    ("moves within registers", r"(unpck|shuf|pshuf|movhl|movlh|punpck)\w*"),
    ("moves of numbers", r"mov([auhl]?p[ds]|sd|dq[au]|[dq])$"),
    ("jumps, calls and their registers", r"j\w+|call|ret|push|pop"),
    ("whole numbers and addresses", r".*"),
]


def executed(program: pathlib.Path, steps: int, ride: list[str]) -> tuple[collections.Counter, int]:
    """How often each instruction of the program ran, by its address, and how many ran in libraries."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "callgrind.out"
        command = ["valgrind", "--tool=callgrind", "--dump-instr=yes", f"--callgrind-out-file={out}", program, str(steps), *ride]
        subprocess.run(command, check=True, capture_output=True)
        lines = out.read_text().splitlines()
    own, elsewhere = collections.Counter(), 0
    names, current, address, of_a_call = {}, "", 0, False
    for line in lines:
        if found := re.match(r"(c?)ob=\((\d+)\)(?: (.*))?$", line):
            called, key, name = found.groups()
            if name:
                names[key] = name
            if not called:
                current = names[key]
        elif line.startswith("calls="):
            of_a_call = True
        elif found := re.match(r"(0x[0-9a-f]+|[+-]\d+|\*) \S+ (\d+)$", line):
            place, cost = found.groups()
            if place.startswith("0x"):
                address = int(place, 16)
            elif place != "*":
                address += int(place)
            if of_a_call:
                of_a_call = False
            elif current == str(program):
                own[address] += int(cost)
            else:
                elsewhere += int(cost)
    return own, elsewhere


def disassembled(program: pathlib.Path) -> dict[int, str]:
    """The mnemonic at each address."""
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], check=True, capture_output=True, text=True).stdout
    return {int(at, 16): mnemonic for at, mnemonic in re.findall(r"^\s+([0-9a-f]+):\s+(\S+)", text, re.MULTILINE)}


def load_address(addresses: list[int], mnemonics: dict[int, str]) -> int:
    """Where the program was loaded: the page at which every executed address is that of an instruction."""
    first = min(addresses) & ~0xFFF
    candidates = (first - offset for offset in range(0, max(mnemonics) + 0x1000, 0x1000))
    return max(candidates, key=lambda base: sum(address - base in mnemonics for address in addresses))


def main(ride: list[str]) -> None:
    subprocess.run(["cargo", "build", "--profile", "fmu-library", "--example", "steps"], cwd=ROOT, check=True)
    program = TARGET / "fmu-library/examples/steps"
    (short, short_elsewhere), (long, long_elsewhere) = (executed(program, steps, ride) for steps in (SHORT, LONG))
    mnemonics = disassembled(program)
    base = load_address(list(long), mnemonics)
    counts = collections.Counter()
    for address, cost in long.items():
        mnemonic = mnemonics.get(address - base, "")
        kind = next(name for name, pattern in KINDS if re.match(pattern, mnemonic))
        counts[kind] += cost - short[address]
    counts["in the C library (memcpy)"] = long_elsewhere - short_elsewhere
    per_step = {name: count / (LONG - SHORT) for name, count in counts.items()}
    for name in [name for name, _ in KINDS] + ["in the C library (memcpy)"]:
        print(f"{per_step.get(name, 0):8.0f}  {name}")
    print(f"{sum(per_step.values()):8.0f}  instructions a step")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
