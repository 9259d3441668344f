"""The pages as a book: every page is a chapter, every link leads somewhere, and the live pages are in it."""

import json
import re

import book
import pytest
from repository import source_files
from test_pages import WITHOUT_THE_RIDE


@pytest.fixture(scope="module")
def built():
    if not book.mdbook():
        pytest.skip("needs mdBook: python3 tests/book.py --install")
    html, failed = book.build()
    if any(WITHOUT_THE_RIDE in reason for reason in failed):
        pytest.skip("needs Rust's target for WebAssembly: rustup target add wasm32-unknown-unknown")
    assert not failed
    return html


def test_every_page_is_one_chapter_of_the_book():
    chapters = re.findall(r"\((.*)\)$", book.summary(), re.MULTILINE)
    pages = [str(book.chapter(file)) for file in source_files() if file.suffix == ".md" and ".github" not in file.parts]
    assert sorted(chapters) == sorted([*pages, *(f"live/{name.removesuffix('.html')}.md" for name in book.LIVE_PAGES)])


def test_every_link_of_the_book_leads_somewhere(built):
    assert list(book.dead_links(built)) == []


def test_every_chapter_is_rendered_and_the_live_pages_are_shown(built):
    chapters = re.findall(r"\((.*)\)$", book.summary(), re.MULTILINE)
    assert [one for one in chapters if not (built / one).with_suffix(".html").exists()] == []
    for name in book.LIVE_PAGES:
        assert f'<iframe src="pages/{name}"' in (built / "live" / name).read_text()
    report = (built / "live" / "pages" / "report.html").read_text()
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', report, re.DOTALL)[1])
    assert data["report"]["simulator"] is not None and len(data["report"]["runs"]) == 1
    assert "classical, fit" in (built / "live" / "pages" / "bench.html").read_text()
    assert "wasm-unsafe-eval" in (built / "live" / "pages" / "ride.html").read_text()


def test_a_dead_link_and_a_missing_anchor_are_found(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "index.html").write_text('<h1 id="top">Top</h1>')
    links = ["folder/", "folder/#top", "#here", "https://example.org/", "gone.html", "folder/index.html#gone", "gone.svg"]
    body = "".join(f'<a href="{link}">link</a>' for link in links[:-1]) + f'<img src="{links[-1]}">'
    (tmp_path / "page.html").write_text(f'<p id="here">{body}</p>')
    assert list(book.dead_links(tmp_path)) == [f"page.html: {link}" for link in links[4:]]
