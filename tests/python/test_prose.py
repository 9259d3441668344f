"""The rules of the repository's prose, which tests/prose.py measures."""

import subprocess
import sys

import prose
import pytest
from conftest import ROOT


def test_the_prose_keeps_its_rules():
    done = subprocess.run([sys.executable, "tests/prose.py", "--check", "--list"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    "sentence, found",
    [
        ("It stops.", "It"),
        ("This is a limit.", "This"),
        ("The platform stops. They return.", "They"),
        ("The rider hardly notices it.", "hardly"),
        ("This page lists limits.", None),
        ("The platform stops: it returns.", None),
    ],
)
def test_pronoun_openings_and_banned_words_are_found(tmp_path, sentence, found):
    page = tmp_path / "page.md"
    page.write_text(f"# Title\n\n{sentence}\n")
    texts = [finding.text for finding in prose.wording([page])]
    assert len(texts) == (found is not None) and all(text.startswith(repr(found)) for text in texts), texts


@pytest.mark.parametrize(
    "comment, sentences, openings",
    [
        ("/// Its name.", 0, 1),
        ("/// It stops.", 1, 1),
        ("/// A guard.\n///\n/// # Errors\n/// It stops.", 1, 0),
        ("/// A limit. They return.", 1, 0),
        ("/// The rider hardly notices the limit.", 0, 0),
    ],
)
def test_pronoun_openings_of_doc_comments_are_found(tmp_path, comment, sentences, openings):
    source = tmp_path / "source.rs"
    source.write_text(f"{comment}\nfn name() {{}}\n")
    assert (len(prose.wording([source])), len(prose.openings([source])[0])) == (sentences, openings)
