#!/usr/bin/env python3
"""Measures the prose of the repository against its rules, and lists what breaks them.

    python3 tests/prose.py [--list] [--check] [FILE ...]

- Openings: doc comments in Rust (`//!` and `///`) that begin with What, Whether or How. A doc comment is a run of such lines; each
  counts once. At most 2 % of them.
- Sentences: their length in words, in README.md, ARCHITECTURE.md and docs/*.md, without code, tables and headings. A list's item
  ends a sentence; a link counts as its text, a piece of code as one word. A mean of at most 16 words, none above 30.
- Lines: at most 100 columns of prose, in those files and in doc comments. Tables, code, links
  and descriptions of variables may be wider.

--list prints each finding with its file and line. --check exits with 1 if a bound is not met.
"""

import argparse
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OPENINGS = 0.02
MEAN = 16.0
LONGEST = 30
COLUMNS = 100

DOC_COMMENT = re.compile(r"^\s*//[/!] ?(?P<text>.*)$")
# A row of a table of variables: the comment above it is the variable's description, one line.
VARIABLE = re.compile(r'\s*(?:Tunable |Fixed )?"[\w.@#\[\]]+" \w+:')
OPENING = re.compile(r"(What|Whether|How)\b")
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
# A point, question or exclamation mark ends a sentence if a capital, a digit or code follows; a colon does not.
SENTENCE_END = re.compile(r"(?<=[.!?])[)\"'*]*\s+(?=[\"'(*`]*[A-Z0-9`])")
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|Eq|eq|eqs|Fig|Figs|No|cf|vs|approx|al)\.$")


@dataclass
class Finding:
    file: Path
    line: int
    text: str

    def __str__(self):
        return f"{self.file.relative_to(ROOT)}:{self.line}: {self.text}"


def tracked(*patterns):
    """The files under version control that match one of the patterns."""
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in listed.stdout.split("\n") if name]


def doc_comments(file):
    """Each run of doc comments: the line it begins on, and its lines."""
    run, begin = [], 0
    for number, line in enumerate(file.read_text().splitlines() + [""], 1):
        match = DOC_COMMENT.match(line)
        if match and not line.lstrip().startswith("////"):
            begin = begin if run else number
            run.append(match["text"])
        elif run:
            yield begin, run
            run = []


def paragraphs(file):
    """Each paragraph and list item of a Markdown file: the line it begins on, and its text."""
    text, begin, in_code = [], 0, False
    for number, line in enumerate(file.read_text().splitlines() + [""], 1):
        fence = line.lstrip().startswith("```")
        skipped = fence or in_code or re.match(r"\s*\||#|    ", line) and not text or not line.strip()
        in_code ^= fence
        item = re.match(r"\s*(?:[-*]|\d+\.)\s+(.*)", line)
        if text and (skipped or item or re.match(r"\s*\||#", line)):
            yield begin, " ".join(text)
            text = []
        if skipped or re.match(r"\s*\||#", line):
            continue
        begin = begin if text else number
        text.append(item[1] if item else line.strip())


def sentences(paragraph):
    """The sentences of a paragraph."""
    text = LINK.sub(lambda match: match[1] or "link", paragraph)
    text = re.sub(r"``?[^`]+``?", "`code`", text)
    parts, kept = SENTENCE_END.split(text), ""
    for part in parts:
        kept = f"{kept} {part}".strip()
        if not ABBREVIATION.search(kept):
            yield kept
            kept = ""
    if kept:
        yield kept


def words(sentence):
    """How many words a sentence has: what has a letter or a digit in it."""
    return sum(1 for word in sentence.split() if re.search(r"\w", word))


def too_wide(file, number, line):
    prose = not re.match(r"\s*(//[/!])?\s*\|", line) and not LINK.search(line) and "http" not in line
    return [Finding(file, number, f"{len(line)} columns")] if prose and len(line) > COLUMNS else []


def openings(files):
    """Doc comments that begin with What, Whether or How, and how many doc comments there are."""
    found, count = [], 0
    for file in files:
        for begin, run in doc_comments(file):
            count += 1
            if OPENING.match(run[0]):
                found.append(Finding(file, begin, run[0]))
    return found, count


def lengths(files):
    """Sentences above the bound, and the length of each sentence."""
    found, counts = [], []
    for file in files:
        for begin, paragraph in paragraphs(file):
            for sentence in sentences(paragraph):
                count = words(sentence)
                counts.append(count)
                if count > LONGEST:
                    found.append(Finding(file, begin, f"{count} words: {sentence}"))
    return found, counts


def wide(sources, pages):
    """Lines of prose that are too wide."""
    found = []
    for file in pages:
        in_code = False
        for number, line in enumerate(file.read_text().splitlines(), 1):
            in_code ^= line.lstrip().startswith("```")
            if not in_code and not line.startswith("    "):
                found += too_wide(file, number, line)
    for file in sources:
        lines = file.read_text().splitlines()
        for number, (line, following) in enumerate(zip(lines, [*lines[1:], ""]), 1):
            if DOC_COMMENT.match(line) and not VARIABLE.match(following):
                found += too_wide(file, number, line)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", action="store_true", help="print each finding")
    parser.add_argument("--check", action="store_true", help="exit with 1 if a bound is not met")
    parser.add_argument("files", nargs="*", help="files or directories to look at [default: all]")
    arguments = parser.parse_args()
    within = arguments.files or ["."]
    chosen = tracked(*within)
    sources = [file for file in chosen if file.suffix == ".rs"]
    pages = [file for file in chosen if file.suffix == ".md" and file.name != "CHANGELOG.md"]
    (opening, comments), (long, counts), columns = openings(sources), lengths(pages), wide(sources, pages)
    mean = sum(counts) / len(counts) if counts else 0.0
    fraction = len(opening) / comments if comments else 0.0
    if arguments.list:
        for finding in [*opening, *long, *columns]:
            print(finding)
    print(f"{len(opening)} of {comments} doc comments begin with What, Whether or How: {fraction:.1%} (at most {OPENINGS:.0%})")
    print(f"{len(counts)} sentences: {mean:.1f} words in the mean (at most {MEAN:.0f}), {len(long)} above {LONGEST} (none)")
    print(f"{len(columns)} lines of prose above {COLUMNS} columns (none)")
    met = fraction <= OPENINGS and mean <= MEAN and not long and not columns
    return 1 if arguments.check and not met else 0


if __name__ == "__main__":
    sys.exit(main())
