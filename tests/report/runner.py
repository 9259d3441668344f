"""What the checks of the pages share: a page that is watched, and the run of all checks in a browser.

A script of checks is called by run.py:

    SCRIPT BROWSER PAGES PICTURES MORIS...

The environment variable CHECKS chooses those with a text in their names.
"""

import os
import sys
import time
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import sync_playwright

BROWSER, PAGES, PICTURES, MORIS = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4:]
IS_FIREFOX = "firefox" in Path(BROWSER).name
# For a picture Playwright adds the style "body {}" in Firefox, which the page's policy forbids: the hash that Firefox names.
OF_PICTURES = "sha256-YjaKGiklmzC6wjXA513HAMmzus8VE61XCOT+SmwNZWA="
LAPTOP, PHONE = {"width": 1366, "height": 768}, {"width": 390, "height": 844}
checks = []


def check(function):
    """A check in Chromium."""
    if not IS_FIREFOX:
        checks.append(function)
    return function


def check_everywhere(function):
    """A check in every browser."""
    checks.append(function)
    return function


def watched(browser, file, *, quiet=True, **options):
    """A page from its file: see `watched_at`."""
    address = file.as_uri()
    return watched_at(browser, address, lambda url: url == address, quiet=quiet, **options)


@contextmanager
def watched_at(browser, address, is_own, *, quiet=True, expected=None, **options):
    """A page, drawn; fails if it says anything unexpected on the console or asks for anything but its own."""
    context = browser.new_context(**{"viewport": LAPTOP} | options)
    page = context.new_page()
    said, asked = [], []
    page.on("console", lambda message: said.append(f"{message.type}: {message.text}"))
    page.on("pageerror", lambda error: said.append(f"error: {error}"))
    page.on("dialog", lambda dialog: (said.append(f"dialog: {dialog.message}"), dialog.dismiss()))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(address)
    if options.get("java_script_enabled", True):
        page.wait_for_selector("#alarm[hidden], body.failed", state="attached")
    yield page
    context.close()
    said = [text for text in said if (expected is None or expected not in text) and not (IS_FIREFOX and OF_PICTURES in text)]
    if quiet:
        assert not said, f"{address} says {said}"
    beyond = [url for url in asked if not is_own(url) and not url.startswith(("data:", "blob:"))]
    assert not beyond, f"{address} asks for {beyond}"


def waiter(shown, names):
    """A function that waits for a condition on these names of what a page shows to its checks."""

    def wait(page, condition):
        """The page forbids texts as scripts, so the polling is done here."""
        end = time.monotonic() + 60
        while not page.evaluate(f"(({{{names}}}) => {condition})({shown})"):
            assert time.monotonic() < end, condition
            page.wait_for_timeout(50)

    return wait


def picture(page, selector):
    """All pixels of a canvas as one text."""
    return page.evaluate(f"document.querySelector('{selector}').toDataURL()")


def launched(playwright):
    if IS_FIREFOX:
        # The browser of a distribution, by the standard protocol; Playwright's own is another.
        return playwright.firefox.launch(executable_path=BROWSER, channel="moz-firefox")
    return playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])


def run_all(subject):
    """Runs the checks, and exits with 1 if any fails."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    chosen = [one for one in checks if os.environ.get("CHECKS", "") in one.__name__]
    failed = 0
    with sync_playwright() as playwright:
        browser = launched(playwright)
        for function in chosen:
            name = function.__name__.replace("_", " ")
            try:
                function(browser)
                print(f"{name:65}ok", flush=True)
            except Exception as failure:  # Whatever went wrong, the other checks still say what they find.
                failed += 1
                print(f"{name:65}FAILED: {failure}", flush=True)
        kind = "Firefox" if IS_FIREFOX else "Chromium"
        print(f"{len(chosen) - failed} of {len(chosen)} checks of {subject} ok in {kind} {browser.version}; pictures in {PICTURES}")
        browser.close()
    sys.exit(1 if failed else 0)
