#!/usr/bin/env python3
"""Builds the pages as a book with mdBook, and checks its links.

    python3 tests/book.py [--install]

The chapters are the links in the tables of docs/README.md, in their order, below its headings. Three chapters more show live
pages that the commands write: a report, the bench, the ride. Files that pages link to are copied beside them. The book is
written to target/book/html. With --install mdBook is installed first, into target/book/mdbook, by cargo.
"""

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

from repository import ROOT, source_files

TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
BOOK = TARGET / "book"
INDEX = ROOT / "docs" / "README.md"
MDBOOK_VERSION = "0.5.4"
MDBOOK_ROOT = BOOK / "mdbook"
LINK = re.compile(r"\[([^\]]*)\]\(([^)#\s]+)[^)\s]*\)")
LIVE_PAGES = {
    "report.html": (
        "A report",
        "moris simulate {recording} --report {live}",
        "[A computed recording](pages/report.html), simulated on the default rig:",
    ),
    "bench.html": (
        "The bench",
        "moris bench --drive slalom,emergency-stop --rig default --strategy classical,predictive --report {live}",
        "[Two drives](pages/bench.html) on the default rig:",
    ),
    "ride.html": (
        "The ride",
        "moris ride --output {live}/ride.html",
        "Click into [the page](pages/ride.html), then ride with the arrow keys:",
    ),
}
"""Each page's title, the command that writes it, and the sentence above it."""


def mdbook():
    """The program's path, or None where it is not installed."""
    return shutil.which("mdbook", path=os.pathsep.join([str(MDBOOK_ROOT / "bin"), os.environ.get("PATH", "")]))


def install():
    """Installs mdBook without its server: a minute of processor time. Does nothing where it is installed."""
    if not mdbook():
        chosen = ["--version", MDBOOK_VERSION, "--locked", "--debug", "--no-default-features", "--features", "search"]
        directories = ["--root", MDBOOK_ROOT, "--target-dir", BOOK / "compiled"]
        environment = os.environ | {"CARGO_PROFILE_DEV_DEBUG": "0"}
        subprocess.run(["cargo", "install", "mdbook", *chosen, *directories], cwd=ROOT, env=environment, check=True)
        shutil.rmtree(BOOK / "compiled")


def linked_file(page, target):
    """The file or directory that a link of a page leads to, or None for an address."""
    return None if ":" in target else (page.parent / unquote(target)).resolve()


def shelves():
    """For each heading of the index: its text, and the title and file of each page in its tables. A page counts once."""
    seen = {INDEX, ROOT / "README.md"}
    for section in INDEX.read_text().split("\n## ")[1:]:
        chapters = []
        for title, target in LINK.findall(section):
            page = linked_file(INDEX, target)
            if page not in seen:
                seen.add(page)
                chapters.append((title[0].upper() + title[1:], page))
        yield section.partition("\n")[0].partition(":")[0], chapters


def chapter(page):
    """A page's path in the book. GitHub's README of a directory is the web's index."""
    return page.relative_to(ROOT).with_name("index.md" if page.name == "README.md" else page.name)


def summary():
    """The text of mdBook's SUMMARY.md."""
    lines = ["# Summary", "", "[MORIS washout](index.md)", "[All pages](docs/index.md)"]
    for heading, chapters in shelves():
        lines += ["", f"# {heading}", "", *(f"- [{title}]({chapter(page)})" for title, page in chapters)]
    lines += ["", "# Live pages", "", *(f"- [{title}](live/{Path(name).stem}.md)" for name, (title, *_) in LIVE_PAGES.items())]
    return "\n".join(lines) + "\n"


def gather(source):
    """Copies the pages and the files that they link to. A linked directory becomes a list of its files."""
    tracked = source_files()
    pages = [ROOT / "README.md", INDEX, *(page for _, chapters in shelves() for _, page in chapters)]
    for page in pages:
        text = page.read_text()
        (source / chapter(page)).parent.mkdir(parents=True, exist_ok=True)
        (source / chapter(page)).write_text(re.sub(r"(\]\([^)#\s]*)README\.md", r"\1index.md", text))
        targets = [target for _, target in LINK.findall(text)]
        for file in filter(None, (linked_file(page, target) for target in targets)):
            if not file.exists() or file in pages:
                continue
            copy = source / file.relative_to(ROOT)
            if file.is_dir():
                names = [one.relative_to(file) for one in tracked if file in one.parents]
                for name in names:
                    (copy / name).parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(file / name, copy / name)
                items = "".join(f'<li><a href="{name}">{name}</a></li>' for name in names)
                (copy / "index.html").write_text(f'<!doctype html><meta charset="utf-8"><title>{copy.name}</title><ul>{items}</ul>')
            else:
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, copy)


def write_live_pages(live):
    """Writes the live pages and a chapter around each. Returns the last line of each command that wrote no page."""
    (live / "pages").mkdir(parents=True)
    recording = live / "pages" / "report.csv"
    subprocess.run([sys.executable, ROOT / "examples" / "recording.py", recording], check=True)
    failed = []
    for name, (title, command, introduction) in LIVE_PAGES.items():
        moris, *words = shlex.split(command.format(live=live / "pages", recording=recording))
        program = [os.environ["MORIS"]] if "MORIS" in os.environ else ["cargo", "run", "--quiet", "--bin", moris, "--"]
        done = subprocess.run([*program, *words], cwd=ROOT, capture_output=True, text=True)
        if not (live / "pages" / name).exists():
            failed.append(f"{command}: {done.stderr.strip().splitlines()[-1:]}")
        frame = f'<iframe src="pages/{name}" title="{title}" width="100%" height="800"></iframe>'
        (live / name).with_suffix(".md").write_text(f"# {title}\n\n{introduction}\n\n{frame}\n")
    return failed


class Links(HTMLParser):
    """The anchors of a page and the addresses that it links to or embeds."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.addresses = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.addresses.append(value)


def dead_links(book):
    """Yields each link of the book's chapters, pictures and live pages that leads nowhere."""
    chapters = {file: Links(file.read_text()) for file in book.rglob("*.html")}
    for file, page in chapters.items():
        for address in page.addresses:
            path, _, anchor = address.partition("#")
            if ":" in path or "/releases" in path:
                continue
            target = (file.parent / unquote(path)).resolve() if path else file
            target = target / "index.html" if target.is_dir() else target
            if not target.exists() or anchor and target in chapters and unquote(anchor) not in chapters[target].anchors:
                yield f"{file.relative_to(book)}: {address}"


def build():
    """Builds the book. Returns its directory and the live pages that could not be written."""
    source, html = BOOK / "src", BOOK / "html"
    for directory in (source, html):
        shutil.rmtree(directory, ignore_errors=True)
    source.mkdir(parents=True)
    gather(source)
    failed = write_live_pages(source / "live")
    (source / "SUMMARY.md").write_text(summary())
    shutil.copyfile(ROOT / "docs" / "book.toml", BOOK / "book.toml")
    subprocess.run([mdbook(), "build", BOOK, "--dest-dir", html], check=True)
    return html, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--install", action="store_true", help="install mdBook first, by cargo")
    if parser.parse_args().install:
        install()
    if not mdbook():
        sys.exit("mdBook is needed: python3 tests/book.py --install")
    book, failed = build()
    wrong = [*failed, *dead_links(book)]
    print(*wrong, f"wrote {book}", sep="\n")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
