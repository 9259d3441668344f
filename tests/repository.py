"""The files of the sources, with git or without."""

import subprocess
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[1]


def source_files():
    """The files that git tracks. In an archive of the sources, or without git: all that .gitignore does not leave out."""
    return git_files() or unpacked_files()


def git_files():
    """Empty where git is missing, refuses the directory, or the sources are not the top of a repository."""
    try:
        top = subprocess.run(["git", "rev-parse", "--show-toplevel"], cwd=ROOT, capture_output=True, text=True)
        if top.returncode or Path(top.stdout.strip()).resolve() != ROOT:
            return []
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=True)
    except FileNotFoundError:
        return []
    # A file may have been deleted since the last commit.
    return [ROOT / name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]


def unpacked_files():
    ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()
    # A pattern that begins with a slash is for the top directory, as in .gitignore.
    patterns = [".git", *(line for line in ignored if line and not line.startswith("#"))]

    def below(directory):
        for path in sorted(directory.iterdir()):
            seen_from_root = PurePosixPath("/", path.relative_to(ROOT).as_posix())
            if any(seen_from_root.match(pattern) for pattern in patterns):
                continue
            if path.is_dir():
                yield from below(path)
            elif path.is_file():
                yield path

    return list(below(ROOT))
