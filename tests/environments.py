#!/usr/bin/env python3
"""Runs README's two commands, as they are printed there, in environments that lack what developers' machines have.

    python3 tests/environments.py [--only NAME ...] [--work DIRECTORY] [--require] [--keep]

Each environment is a clone or an unpacked archive of the sources with its own PATH, HOME, CARGO_HOME and target directory. A table
at the end has the result of each command: passed, with its seconds and its processor time, or refused, with the line that says
so. What this machine lacks for an environment is reported as not available; with --require that is an error. For Linux. Where the
script is run as root, nobody is the ordinary user.
"""

import argparse
import os
import platform
import re
import resource
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from repository import ROOT, source_files

SYSTEM_PATH = ("/usr/local/bin", "/usr/bin", "/bin", "/usr/local/sbin", "/usr/sbin", "/sbin")
COMPILERS = r"(.*-)?(cc|c89|c99|gcc|g\+\+|c\+\+|clang|clang\+\+|tcc)(-[\d.]+)?"
"""Names of C compilers, as a pattern."""
RUST_PROGRAMS = r"cargo.*|rust.*"
PASSED_ON = re.compile(r"PIP_.*|SSL_.*|CARGO_HTTP_.*|CARGO_REGISTRIES_.*|.*_proxy", re.IGNORECASE)
"""Variables by which this machine reaches the registries."""
WEBASSEMBLY = "wasm32-unknown-unknown"
LINKED_SIZE = 100_000
"""Smaller files of a toolchain are copied, because rustup writes to them [bytes]."""
MEMORY_LIMIT = 4 << 30
WITHOUT_ENSUREPIP = 'import sys\nsys.modules["ensurepip"] = None\n'
LOOPBACK_ALONE = """
import fcntl, os, socket, struct, sys
with socket.socket() as any_socket:
    fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh", b"lo", 0x41))  # SIOCSIFFLAGS: up, running
os.execvp(sys.argv[1], sys.argv[1:])
"""
"""Raises the loopback of a new network namespace, and becomes the command."""
OFFLINE = "without network: "


class NotAvailable(Exception):
    """What this machine lacks for an environment, and how to get it."""


@dataclass(frozen=True)
class Environment:
    lacks: str
    # Numbers of README's commands from 0 on, or commands of its own.
    commands: tuple = (0, 1)
    # Refusals that must be said in one line, by the place of the command.
    refused: dict = field(default_factory=dict)
    is_archive: bool = False
    has_rustup: bool = False
    is_ordinary_user: bool = False
    has_read_only_sources: bool = False
    is_small: bool = False
    hidden: str = r"(?!)"
    toolchain: str | None = None
    python: str | None = None
    has_ensurepip: bool = True
    folder: str = "sources"
    variables: dict = field(default_factory=dict)


def oldest_rust():
    return re.search(r'^rust-version = "(.+)"', (ROOT / "Cargo.toml").read_text(), re.MULTILINE)[1]


TESTS_OFFLINE = f"{OFFLINE}1"
INSTALL = "cargo install --locked --path crates/workbench/moris"
# Outside of the sources, which are gone by then.
INSTALLED = "cd $HOME && mv $SOURCES $SOURCES.away && moris --version && moris simulate ride.csv && moris rig check --help"
ENVIRONMENTS = {
    "stranger": Environment(
        "WebAssembly target, git and .git, root's rights, rustup",
        commands=(1,), is_archive=True, hidden="git", is_ordinary_user=True,
    ),
    "no-target": Environment("WebAssembly target; rustup is there", has_rustup=True),
    "no-git": Environment("git and .git", is_archive=True, hidden="git"),
    "path": Environment(
        "plain path, UTF-8, whole hours",
        folder="Quellen für Übung", variables={"LANG": "C", "LC_ALL": "C", "TZ": "Asia/Kathmandu"},
    ),
    "user": Environment("root's rights, rustup", is_ordinary_user=True),
    "oldest-rust": Environment(f"Rust newer than {oldest_rust()}", toolchain=oldest_rust()),
    "newest-rust": Environment("an older Rust", toolchain="stable"),
    "python-3.10": Environment("newer Python", python="python3.10"),
    "python-3.13": Environment("older Python", python="python3.13"),
    "old-python": Environment("Python 3.10", commands=(1,), python="python3.9", refused={0: "Python 3.10 or newer is needed"}),
    "no-ensurepip": Environment("ensurepip", commands=(1,), has_ensurepip=False, refused={0: r"apt install python3\.\d+-venv"}),
    "no-cargo": Environment("Rust", commands=(1,), hidden="rustc", toolchain="none", refused={0: r"install Rust from https://rustup\.rs"}),
    "no-compiler": Environment(
        "C compiler", hidden=COMPILERS, refused={0: "linker `cc` not found", 1: "apt install gcc libc6-dev"}
    ),
    "offline": Environment("network in the second run", commands=(1, TESTS_OFFLINE)),
    "read-only": Environment(
        "right to write into the sources", is_ordinary_user=True, has_read_only_sources=True, variables={"CARGO_TARGET_DIR": "$HOME/target"}
    ),
    "small": Environment("second core, more than 4 GB", is_small=True),
    "installed": Environment("sources", commands=("python3 examples/recording.py $HOME/ride.csv", INSTALL, INSTALLED)),
}


def readme_commands():
    """The commands of README's first block, without their comments."""
    block = re.search(r"^```sh\n(.*?)^```", (ROOT / "README.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[1]
    return [line.split("#")[0].strip() for line in block.splitlines()]


@cache
def sysroot(toolchain):
    """The directory of this machine's toolchain, or of the one that rustup calls so."""
    asked = ["rustc"] if toolchain is None else ["rustup", "run", toolchain, "rustc"]
    try:
        printed = subprocess.run([*asked, "--print", "sysroot"], cwd=ROOT, capture_output=True, text=True)
    except FileNotFoundError:
        raise NotAvailable(f"{asked[0]}: https://rustup.rs") from None
    if printed.returncode:
        raise NotAvailable(f"Rust {toolchain}: rustup toolchain install {toolchain}")
    return Path(printed.stdout.strip())


def copy_toolchain(source, copy):
    """A copy without documentation and the WebAssembly target. Large files are links where that is possible."""

    def link_or_copy(file, made):
        try:
            if os.path.getsize(file) < LINKED_SIZE:
                raise OSError
            os.link(file, made)
        except OSError:
            shutil.copy2(file, made)

    left_out = shutil.ignore_patterns("share", "src", "etc", f"*{WEBASSEMBLY}*")
    shutil.copytree(source, copy, symlinks=True, copy_function=link_or_copy, ignore=left_out)
    components = copy / "lib" / "rustlib" / "components"
    if components.exists():
        components.write_text("".join(line for line in components.read_text().splitlines(True) if WEBASSEMBLY not in line))


def interpreter(name):
    """The real program of a Python: on the path, or a version of pyenv."""
    if name is None:
        return Path(shutil.which("python3", path=os.pathsep.join(SYSTEM_PATH)) or sys.executable).resolve()
    found = [shutil.which(name), *sorted(Path.home().glob(f".pyenv/versions/*/bin/{name}"))]
    for program in filter(None, found):
        asked = subprocess.run([program, "-c", "import sys; print(sys.executable)"], cwd=ROOT, capture_output=True, text=True)
        if asked.returncode == 0:
            return Path(asked.stdout.strip()).resolve()
    raise NotAvailable(f"{name}: install it")


def is_reachable(path):
    """True if an ordinary user may run a program there."""
    return all(parent.stat().st_mode & stat.S_IXOTH for parent in [path, *path.parents])


class Prepared:
    """An environment on the disk: its sources, programs and variables."""

    def __init__(self, environment, work):
        self.environment, self.work = environment, work
        self.user = "nobody" if environment.is_ordinary_user and os.geteuid() == 0 else None
        self.home, self.sources, self.programs = work / "home", work / environment.folder, work / "programs"
        for folder in (self.home / ".cargo", self.programs):
            folder.mkdir(parents=True)
        self.link_programs()
        self.copy_sources()
        self.variables = {
            **{name: value for name, value in os.environ.items() if PASSED_ON.fullmatch(name)},
            "HOME": str(self.home),
            "CARGO_HOME": str(self.home / ".cargo"),
            "PATH": f"{self.programs}:{self.home / '.cargo' / 'bin'}",
            "LANG": "C.UTF-8",
            "SOURCES": str(self.sources),
        }
        if environment.has_rustup:
            self.variables["RUSTUP_HOME"] = str(self.home / ".rustup")
        if not environment.has_ensurepip:
            (self.home / "site").mkdir()
            (self.home / "site" / "sitecustomize.py").write_text(WITHOUT_ENSUREPIP)
            self.variables["PYTHONPATH"] = str(self.home / "site")
        self.variables |= {name: value.replace("$HOME", str(self.home)) for name, value in environment.variables.items()}
        self.copy_cargo_configuration()
        if self.user:
            self.give_away()
        if environment.has_read_only_sources:
            for path in [*self.sources.rglob("*"), self.sources]:
                path.chmod(path.stat().st_mode & ~0o222)

    def link_programs(self):
        """The programs of the system without those that are hidden, then Python and Rust."""
        hidden = re.compile(f"{RUST_PROGRAMS}|{self.environment.hidden}")
        for folder in map(Path, SYSTEM_PATH):
            for program in sorted(folder.iterdir()) if folder.is_dir() else ():
                if not hidden.fullmatch(program.name) and not (self.programs / program.name).is_symlink():
                    (self.programs / program.name).symlink_to(program)
        (self.programs / "python3").unlink(missing_ok=True)
        python = interpreter(self.environment.python)
        if self.environment.is_ordinary_user and os.geteuid() == 0 and not is_reachable(python):
            raise NotAvailable(f"a python3 that ordinary users may run, in {' or '.join(SYSTEM_PATH[:2])}")
        (self.programs / "python3").symlink_to(python)
        if self.environment.toolchain == "none":
            return
        found = sysroot(self.environment.toolchain)
        if not self.environment.has_rustup:
            copy_toolchain(found, self.work / "toolchain")
            for program in (self.work / "toolchain" / "bin").iterdir():
                (self.programs / program.name).symlink_to(program)
            return
        rustup = shutil.which("rustup")
        if not rustup:
            raise NotAvailable("rustup: https://rustup.rs")
        copy_toolchain(found, self.home / ".rustup" / "toolchains" / found.name)
        (self.home / ".rustup" / "settings.toml").write_text(f'version = "12"\ndefault_toolchain = "{found.name}"\nprofile = "minimal"\n')
        for program in ("cargo", "rustc", "rustdoc", "rustup"):
            (self.programs / program).symlink_to(Path(rustup).resolve())

    def copy_sources(self):
        """With the changes that are not committed yet."""
        if not self.environment.is_archive:
            if not (ROOT / ".git").exists() or not shutil.which("git"):
                raise NotAvailable("the sources are no git repository")
            subprocess.run(["git", "clone", "--quiet", ROOT, self.sources], check=True)
        for file in source_files():
            copy = self.sources / file.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(file, copy)

    def copy_cargo_configuration(self):
        """By which this machine reaches a registry."""
        own = Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))
        for name in ("config.toml", "config"):
            if (own / name).is_file():
                shutil.copy2(own / name, self.home / ".cargo" / name)

    def give_away(self):
        if not is_reachable(self.work):
            raise NotAvailable(f"a folder that ordinary users may enter, in place of {self.work}: --work DIRECTORY")
        for top in (self.home, self.sources):
            for path in [top, *top.rglob("*")]:
                shutil.chown(path, self.user, follow_symlinks=False) if sys.version_info >= (3, 13) else os.lchown(path, *ids(self.user))

    def run(self, command, log):
        """Runs a command of the shell. Returns its exit status, its output, its seconds and its processor time."""
        is_offline = command.startswith(OFFLINE)
        command = ["bash", "-c", command.removeprefix(OFFLINE)]
        if is_offline:
            without = ["unshare", "--net"] if os.geteuid() == 0 else ["unshare", "--net", "--map-root-user"]
            command = [*without, str(self.programs / "python3"), "-c", LOOPBACK_ALONE, *command]
        options = {"user": self.user, "group": ids(self.user)[1], "extra_groups": []} if self.user else {}
        begin, used = time.monotonic(), processor_time()
        limit = Limit() if self.environment.is_small else None
        with open(log, "w") as out:
            done = subprocess.run(
                command, cwd=self.sources, env=self.variables, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT,
                preexec_fn=limit and limit.enter, **options,
            )
        output = Path(log).read_text(errors="replace")
        return done.returncode, output, time.monotonic() - begin, processor_time() - used


def ids(user):
    import pwd

    entry = pwd.getpwnam(user)
    return entry.pw_uid, entry.pw_gid


class Limit:
    """One core and 4 GB: of all processes together where this script may make a control group, else of each."""

    def __init__(self):
        self.core = min(os.sched_getaffinity(0))
        self.group = None
        for top, name in (("/sys/fs/cgroup/memory", "memory.limit_in_bytes"), ("/sys/fs/cgroup", "memory.max")):
            group = Path(top, f"moris-environment-{os.getpid()}")
            try:
                group.mkdir(exist_ok=True)
                (group / name).write_text(str(MEMORY_LIMIT))
                self.group = group
                return
            except OSError:
                continue

    def enter(self):
        """In the child, before the command."""
        os.sched_setaffinity(0, {self.core})
        if self.group:
            (self.group / "cgroup.procs").write_text(str(os.getpid()))
        else:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))


def processor_time():
    """Of the processes that have ended [s]."""
    times = os.times()
    return times.children_user + times.children_system


def result_of(prepared, command, refusal, log):
    """A word for the table, and whether it is what is expected."""
    status, output, seconds, used = prepared.run(command, log)
    lines = [line for line in output.splitlines() if line.strip()]
    if refusal is None:
        if status == 0:
            return f"passed: {seconds:.0f} s, processor {used:.0f} s", True
        return f"FAILED with {status}: {lines[-1] if lines else 'says nothing'}; {log}", False
    found = next((line for line in lines if re.search(refusal, line)), None)
    # What cargo refuses while it compiles is beyond this project.
    is_early = len(lines) == 1 or not command.startswith("python3")
    if status and found and is_early:
        return f"refused: {found.strip()}", True
    return f"NOT REFUSED in one line ({status}): {refusal}; {log}", False


def run_environment(name, environment, work, keeps):
    """Rows of the table, and whether all is as expected."""
    folder = work / name
    rows, fine = [], True
    try:
        prepared = Prepared(environment, folder)
        for place, command in enumerate(environment.commands):
            offline = isinstance(command, str) and command.startswith(OFFLINE)
            number = int(command.removeprefix(OFFLINE)) if offline else command
            printed = readme_commands()[number] if isinstance(number, int) else number
            log = folder / f"{place}.log"
            print(f"{name}: {OFFLINE if offline else ''}{printed}", flush=True)
            text, as_expected = result_of(prepared, (OFFLINE if offline else "") + printed, environment.refused.get(place), log)
            print(f"  {text}", flush=True)
            rows.append((name, (OFFLINE if offline else "") + printed, text))
            fine &= as_expected
            if not as_expected:
                print(*log.read_text(errors="replace").splitlines()[-40:], sep="\n", flush=True)
                break
    finally:
        if fine and not keeps:
            # Read-only folders cannot be emptied.
            for path in folder.rglob("*") if environment.has_read_only_sources else ():
                path.is_dir() and not path.is_symlink() and path.chmod(0o700)
            shutil.rmtree(folder, ignore_errors=True)
    return rows, fine


def main():
    described = "\n".join(f"  {name:14} without {environment.lacks}" for name, environment in ENVIRONMENTS.items())
    parser = argparse.ArgumentParser(
        description=f"{__doc__.splitlines()[0]}\nThe environments:\n{described}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", action="append", choices=ENVIRONMENTS, metavar="NAME", help="this environment")
    parser.add_argument("--work", type=Path, help="folder for the environments, 6 GB each [default: a temporary one]")
    parser.add_argument("--require", action="store_true", help="an environment that is not available is an error")
    parser.add_argument("--keep", action="store_true", help="leave what was compiled; what failed is always left")
    options = parser.parse_args()
    if sys.platform != "linux":
        sys.exit(f"The environments are made on Linux, and this is {platform.system()}.")
    work = options.work or Path(tempfile.mkdtemp(prefix="moris-environments-"))
    work = work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    work.chmod(0o755)
    rows, fine = [], True
    for name in options.only or ENVIRONMENTS:
        try:
            found, as_expected = run_environment(name, ENVIRONMENTS[name], work, options.keep)
        except NotAvailable as reason:
            found, as_expected = [(name, "", f"not available here ({reason})")], not options.require
            print(f"{name}: {found[0][2]}", flush=True)
        rows += found
        fine &= as_expected
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    print(*(f"{name:{widths[0]}}  {command:{widths[1]}}  {text}" for name, command, text in rows), sep="\n")
    sys.exit(0 if fine else 1)


if __name__ == "__main__":
    main()
