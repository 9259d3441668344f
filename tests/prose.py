#!/usr/bin/env python3
"""Measures the prose of the repository against its rules, and lists what breaks them.

    python3 tests/prose.py [--list] [--check] [--wrap] [FILE ...]

- Openings: doc comments in Rust (`//!` and `///`) that begin with What, Whether, How or a pronoun such as Its or Those. A doc
  comment is a run of such lines; each counts once. At most 0.2 % of them.
- Fragments: doc comments of at most three words, such as "Its name.", which say nothing alone. At most 5.5 % of them.
- Sentences: their length in words, in the pages, in the documentation packed into the FMUs, in doc comments and in Python's
  docstrings. Code, tables and headings do not count. A list's item ends a sentence; a link counts as its
  text, a piece of code as one word. A mean of at most 16 words a page (not of docstrings), none above 30.
- Wording: no sentence of the pages and of doc comments begins with a pronoun in place of its subject. None of the pages has a word
  of BETTER_WORDS, which has a better one for each. PERMITTED_OPENINGS has the exceptions.
- Lines: at most 100 columns of prose, in the pages and in doc comments. Tables, code, pictures,
  addresses and descriptions of variables may be wider.

--list prints each finding with its file and line. --check exits with 1 if a bound is not met. --wrap breaks the lines of
each paragraph that is too wide, and changes no word.
"""

import argparse
import ast
import re
import sys
from dataclasses import dataclass
from pathlib import Path

from repository import ROOT, source_files

OPENINGS = 0.002
FRAGMENTS = 0.055
FRAGMENT = 3  # words
MEAN = 16.0
LONGEST = 30
COLUMNS = 100
PYTHON = (".py", ".pyi")
UNBREAKABLE = 60  # columns of one piece, an address or code, beyond which its line may be wider

DOC_COMMENT = re.compile(r"^\s*//[/!] ?(?P<text>.*)$")
# A row of a table of variables: the comment above it is the variable's description, one line.
VARIABLE = re.compile(r'\s*(?:Tunable |Fixed )?"[\w.@#\[\]]+" \w+:')
OPENING = re.compile(r"(What|Whether|How|It|Its|They|Their|This|These|That|Those|Who|Whoever)\b")
# "This page has" names its subject; "This has" does not.
PRONOUN_OPENING = re.compile(
    r"[*(]*(It|They|Them|He|She|Who|Whoever|(This|These|Those|That)(?= "
    r"(is|are|was|were|has|have|had|does|do|can|may|must|will|would|takes|gives|needs|holds|makes|costs|means|shows|says)\b))\b"
)
BETTER_WORDS = {
    "asks? more": "exceeds",
    "as a person": "as the operator",
    "go(es)? on": "continues",
    "hardly": "nearly no",
    "mak(e|es|ing) up for": "compensates",
    "of a person": "of the operator",
    "of one's own": "of your own",
    "seldom": "rarely",
    "what it would": "what the platform would",
    "who sets": "the default is",
}
BANNED_WORD = re.compile(rf"\b({'|'.join(BETTER_WORDS)})\b", re.IGNORECASE)
# Beginnings of sentences to which the two rules do not apply, each with its reason.
PERMITTED_OPENINGS: dict[str, str] = {}
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


def chosen_files(within):
    """The files of the sources that are one of these paths, or below one of them."""
    wanted = {(ROOT / path).resolve() for path in within}
    return [file for file in source_files() if wanted & {file, *file.parents}]


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
    """Each paragraph and list item of a page or of a source's doc comments: the line it begins on, and its text."""
    if file.suffix == ".md":
        return markdown_paragraphs(file.read_text().splitlines())
    if file.suffix == ".html":
        return html_paragraphs(file)
    return docstring_paragraphs(file) if file.suffix in PYTHON else comment_paragraphs(file)


def markdown_paragraphs(lines):
    """Each paragraph and list item of Markdown: the line it begins on, and its text."""
    text, begin, in_code = [], 0, False
    for number, line in enumerate([*lines, ""], 1):
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


def html_paragraphs(file):
    """Each paragraph, item and table cell of an HTML page: the line it begins on, and its text."""
    text = re.sub(r"<code>.*?</code>", "`code`", file.read_text(), flags=re.DOTALL)
    for block in re.finditer(r"<(p|li|td)>(.*?)(?=</\1>|<\1>)", text, flags=re.DOTALL):
        yield text.count("\n", 0, block.start()) + 1, " ".join(re.sub(r"<[^>]*>|&\w+;", "", block[2]).split())


def comment_paragraphs(file):
    """Each paragraph and item of the doc comments: the line that the comment begins on, and its text."""
    for begin, run in doc_comments(file):
        for _, text in markdown_paragraphs(run):
            yield begin, text


def docstring_paragraphs(file):
    """Each paragraph and item of the docstrings: the line that the docstring begins on, and its text."""
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in ast.walk(ast.parse(file.read_text())):
        text = ast.get_docstring(node) if isinstance(node, documented) else None
        # A description of a parameter or an option is an item.
        lines = re.sub(r"(^|\. )(?=--\w|[^\s.:][^.:]{0,60}: )", r"\1\n- ", text or "", flags=re.MULTILINE).splitlines()
        for _, paragraph in markdown_paragraphs(lines):
            yield node.body[0].lineno, paragraph


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


def is_wide(line):
    """A line beyond the bound that could be broken: no row of a table, no picture, nothing in one long piece."""
    breakable = not re.match(r"\s*(//[/!])?\s*(\||!\[)", line) and max(map(len, pieces(line)), default=0) <= UNBREAKABLE
    return len(line) > COLUMNS and breakable


def too_wide(file, number, line):
    return [Finding(file, number, f"{len(line)} columns")] if is_wide(line) else []


def pieces(text):
    """The words of a text, with what must not be divided in one piece: code, and a mark that would begin a list."""
    joined = re.sub(r"(``?)[^`]+\1", lambda code: code[0].replace(" ", "\0"), text)
    joined = re.sub(r"(?<=\S)[ ]+(?=([-+*#>=|]+|\d+[.)])(\s|$))", "\0", joined)
    return [piece.replace("\0", " ") for piece in joined.split()]


def filled(words, first, later, columns):
    """The words in lines of at most so many columns; `first` and `later` stand before them."""
    lines, line, empty = [], first, True
    for word in words:
        if not empty and len(line) + 1 + len(word) > columns:
            lines.append(line)
            line, empty = later, True
        line, empty = line + ("" if empty else " ") + word, False
    return [*lines, line]


def wrapped(block, prefix):
    """A paragraph or an item of a list, its lines after `prefix` filled, without a short last line where that can be."""
    item = re.match(r"\s*(?:[-*+]\s+|\d+\.\s+)?", block[0])[0]
    words = pieces(" ".join([block[0][len(item):], *block[1:]]))
    later = prefix + " " * len(item)
    widest = filled(words, prefix + item, later, COLUMNS)
    for columns in range(COLUMNS, COLUMNS - 20, -1):
        lines = filled(words, prefix + item, later, columns)
        if len(lines) == len(widest) and len(lines[-1]) - len(later) > 20:
            return lines
    return widest


def wrapped_lines(lines, prefix):
    """Markdown with the paragraphs filled that are too wide. `prefix` stands before each line."""
    result, block, in_code = [], [], False

    def end():
        wide_block = block and any(is_wide(prefix + line) for line in block)
        result.extend(wrapped(block, prefix) if wide_block else [(prefix + line).rstrip() for line in block])
        block.clear()

    for line in lines:
        fence = line.lstrip().startswith("```")
        literal = fence or in_code or not line.strip() or re.match(r"\s*\||#|!\[|\s*\[\w+\]:", line)
        literal = literal or not block and line.startswith("    ") and not re.match(r"\s*[-*] ", line)
        in_code ^= fence
        if literal or re.match(r"\s*(?:[-*+]|\d+\.)\s+", line):
            end()
        if literal:
            result.append((prefix + line).rstrip())
        else:
            block.append(line)
    end()
    return result


def wrap(file):
    """Breaks the lines of the file's paragraphs that are too wide."""
    before = file.read_text().splitlines()
    if file.suffix == ".md":
        after = wrapped_lines(before, "")
    else:
        after, at = [], 0
        while at < len(before):
            mark = re.match(r"\s*//[/!](?!/)", before[at])
            end = at + 1
            while mark and end < len(before) and re.match(re.escape(mark[0]) + r"(?!/)", before[end]):
                end += 1
            following = before[end] if end < len(before) else ""
            if mark and not VARIABLE.match(following):
                texts = [re.sub("^ ", "", line[len(mark[0]):]) for line in before[at:end]]
                after += wrapped_lines(texts, mark[0] + " ")
            else:
                after += before[at:end]
            at = end
    if after != before:
        file.write_text("\n".join(after) + "\n")


def openings(files):
    """Doc comments that begin with What, Whether, How or a pronoun, and how many doc comments there are."""
    found, count = [], 0
    for file in files:
        for begin, run in doc_comments(file):
            count += 1
            if OPENING.match(run[0]):
                found.append(Finding(file, begin, run[0]))
    return found, count


def lengths(pages):
    """Sentences and means above the bounds, and the length of each sentence."""
    found, all_counts = [], []
    for page in pages:
        counts = []
        for begin, paragraph in paragraphs(page):
            for sentence in sentences(paragraph):
                counts.append(words(sentence))
                if counts[-1] > LONGEST:
                    found.append(Finding(page, begin, f"{counts[-1]} words: {sentence}"))
        mean = sum(counts) / max(len(counts), 1)
        if mean > MEAN and page.suffix not in PYTHON:
            found.append(Finding(page, 1, f"{mean:.1f} words a sentence in the mean"))
        all_counts += counts
    return found, all_counts


def wording(files):
    """Sentences that begin with a pronoun, and those of pages that have a banned word."""
    found = []
    for page in files:
        for begin, paragraph in paragraphs(page):
            for sentence in sentences(paragraph):
                pronoun = PRONOUN_OPENING.match(sentence)
                banned = page.suffix == ".md" and BANNED_WORD.search(sentence)
                if sentence.startswith(tuple(PERMITTED_OPENINGS)) or not (pronoun or banned):
                    continue
                better = "name the subject"
                if not pronoun:
                    better = next(b for w, b in BETTER_WORDS.items() if re.fullmatch(w, banned[0], re.IGNORECASE))
                found.append(Finding(page, begin, f"{(pronoun or banned)[0]!r} ({better}): {sentence}"))
    return found


def fragments(sources):
    """Doc comments of few words."""
    texts = ((file, begin, " ".join(run).split()) for file in sources for begin, run in doc_comments(file))
    return [Finding(file, begin, " ".join(words)) for file, begin, words in texts if len(words) <= FRAGMENT]


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
        lines, in_code = file.read_text().splitlines(), False
        for number, (line, following) in enumerate(zip(lines, [*lines[1:], ""]), 1):
            match = DOC_COMMENT.match(line)
            in_code = bool(match) and in_code ^ match["text"].lstrip().startswith("```")
            if match and not in_code and not match["text"].startswith("    ") and not VARIABLE.match(following):
                found += too_wide(file, number, line)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", action="store_true", help="print each finding")
    parser.add_argument("--check", action="store_true", help="exit with 1 if a bound is not met")
    parser.add_argument("--wrap", action="store_true", help="break the lines that are too wide")
    parser.add_argument("files", nargs="*", help="files or directories to look at [default: all]")
    arguments = parser.parse_args()
    within = arguments.files or ["."]
    chosen = chosen_files(within)
    sources = [file for file in chosen if file.suffix == ".rs"]
    pages = [file for file in chosen if file.suffix == ".md"]
    scripts = [file for file in chosen if file.suffix in PYTHON]
    packed = [file for file in chosen if file.suffix == ".html" and "documentation" in file.parts]
    for file in [*sources, *pages] if arguments.wrap else []:
        wrap(file)
    (opening, comments), (long, counts), columns = openings(sources), lengths([*pages, *packed, *sources, *scripts]), wide(sources, pages)
    worded = wording([*pages, *sources])
    mean = sum(counts) / max(len(counts), 1)
    fraction = len(opening) / max(comments, 1)
    short = fragments(sources)
    fraction_short = len(short) / max(comments, 1)
    if arguments.list:
        for finding in [*opening, *(short if fraction_short > FRAGMENTS else []), *long, *worded, *columns]:
            print(finding)
    print(f"{len(opening)} of {comments} doc comments begin with What, Whether, How or a pronoun: {fraction:.1%} (at most {OPENINGS:.1%})")
    print(f"{len(short)} doc comments have at most {FRAGMENT} words: {fraction_short:.1%} (at most {FRAGMENTS:.1%})")
    print(f"{len(counts)} sentences of {mean:.1f} words in the mean: {len(long)} above {LONGEST}, or pages above {MEAN:.0f} (none)")
    print(f"{len(worded)} sentences begin with a pronoun or have a banned word (none)")
    print(f"{len(columns)} lines of prose above {COLUMNS} columns (none)")
    met = fraction <= OPENINGS and fraction_short <= FRAGMENTS and not long and not worded and not columns
    return 1 if arguments.check and not met else 0


if __name__ == "__main__":
    sys.exit(main())
