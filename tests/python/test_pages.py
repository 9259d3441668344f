"""Policies of the pages' contents: nothing runs and nothing is styled but what a hash in the page's head names."""

import base64
import hashlib
import json
import os
import re
import subprocess
import urllib.request
from html.parser import HTMLParser

import pytest
from conftest import ROOT

MORIS = [os.environ["MORIS"]] if "MORIS" in os.environ else ["cargo", "run", "--quiet", "--bin", "moris", "--"]
LIVE = [*MORIS, "live"] if "MORIS" in os.environ else ["cargo", "run", "--quiet", "--bin", "moris-live", "--"]
RUNS = {"", "module", "text/javascript"}
"""Types of scripts that a browser runs."""
WITHOUT_THE_RIDE = "moris was built without the ride"
"""What the command says where the target for WebAssembly was missing as it was compiled."""


class Page(HTMLParser):
    """A page's policies, the texts of its scripts and styles, and attributes that only an inline policy permits."""

    def __init__(self, text):
        super().__init__(convert_charrefs=False)
        self.policies, self.texts, self.attributes, self.within = [], {"script": [], "style": []}, [], None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        if tag == "meta" and named.get("http-equiv", "").lower() == "content-security-policy":
            assert not any(self.texts.values()), "what stands before a policy is free of it"
            self.policies.append(named["content"])
        self.attributes += [(tag, name) for name, value in attributes if name == "style" or name.startswith("on") or "javascript:" in (value or "")]
        runs = tag == "style" or tag == "script" and named.get("type", "") in RUNS
        self.within = tag if runs else None
        if runs:
            self.texts[tag].append("")

    def handle_data(self, data):
        if self.within:
            self.texts[self.within][-1] += data

    def handle_endtag(self, tag):
        self.within = None


def directives(policy):
    parts = [part.split() for part in policy.split(";") if part.strip()]
    assert len({part[0] for part in parts}) == len(parts), policy
    return {name: sources for name, *sources in parts}


def check(text, scripts):
    """A page with so many scripts. Returns its policy."""
    page = Page(text)
    [policy] = page.policies
    assert "unsafe-inline" not in policy and "unsafe-eval" not in policy.replace("wasm-unsafe-eval", "")
    allowed = directives(policy)
    assert [allowed[name] for name in ("default-src", "base-uri", "form-action")] == [["'none'"]] * 3
    assert page.attributes == []
    assert [len(page.texts[kind]) for kind in ("script", "style")] == [scripts, 1]
    for kind, texts in page.texts.items():
        hashes = [source for source in allowed.get(f"{kind}-src", []) if source.startswith("'sha256-")]
        digests = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in texts]
        assert hashes == [f"'sha256-{digest}'" for digest in digests], kind
    return allowed


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with a report for each of two recordings, and the list of them."""
    folder = tmp_path_factory.mktemp("pages")
    (folder / "rides").mkdir()
    for name, lateral in (("one", 0.5), ("two", -0.5)):
        rows = [f"{0.01 * k},0.3,{lateral},9.80665,0,0,0" for k in range(300)]
        (folder / "rides" / f"{name}.csv").write_text("\n".join(["time,ax,ay,az,wx,wy,wz", *rows, ""]))
    simulated = subprocess.run([*MORIS, "simulate", folder / "rides", "--no-bound", "--report", folder], cwd=ROOT, capture_output=True, text=True)
    assert simulated.returncode in (0, 3), simulated.stderr
    return folder


def test_reports_run_only_their_own_scripts(made):
    for name in ("one", "two"):
        allowed = check((made / f"{name}.html").read_text(), 2)
        assert allowed["worker-src"] == ["blob:"] and "connect-src" not in allowed


def test_a_report_has_sliders_or_says_why_it_has_none(made):
    text = (made / "one.html").read_text()
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
    reason = data["report"]["no_simulator_because"]
    assert (reason is None) == (data["report"]["simulator"] is not None) == (data["worker"] is not None)
    assert reason is None or "rustup target add wasm32-unknown-unknown" in reason


def test_the_list_of_reports_has_no_script(made):
    assert "script-src" not in check((made / "index.html").read_text(), 0)


def test_the_page_to_ride_runs_only_its_own_scripts(tmp_path):
    page = tmp_path / "ride.html"
    written = subprocess.run([*MORIS, "ride", "--output", page], cwd=ROOT, capture_output=True, text=True)
    if WITHOUT_THE_RIDE in written.stderr:
        pytest.skip("needs Rust's target for WebAssembly: rustup target add wasm32-unknown-unknown")
    assert written.returncode == 0, written.stderr
    allowed = check(page.read_text(), 2)
    assert allowed["script-src"][-1] == "'wasm-unsafe-eval'" and "connect-src" not in allowed


def test_the_page_of_live_runs_only_its_own_scripts():
    live = [*LIVE, "--from", "ride", "--dry", "--page", "--for", "30"]
    with subprocess.Popen(live, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        address = next(said.removeprefix("page: ").strip() for said in process.stderr if said.startswith("page: "))
        with urllib.request.urlopen(address) as answer:
            allowed = check(answer.read().decode(), 2)
        process.terminate()
    assert all(source.startswith("'sha256-") for source in allowed["script-src"]) and allowed["connect-src"] == ["'self'"]


def test_a_changed_script_has_another_hash(made):
    text = (made / "one.html").read_text()
    with pytest.raises(AssertionError):
        check(text.replace('"use strict";', '"use  strict";', 1), 2)
    with pytest.raises(AssertionError):
        check(text.replace("<main", '<main style="color: red"', 1), 2)
