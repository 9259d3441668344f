"""ARCHITECTURE.md's rule of blocks and its table of uses, held against the manifests, and what is compiled once for all."""

import re
import subprocess

import pytest
from conftest import ROOT

tomllib = pytest.importorskip("tomllib", reason="needs tomllib: run the tests with Python 3.11 or newer")

# Path of a package -> its ring. Washout and machinery are one ring: they use each other.
RINGS = (("crates/live/command/", 2), ("crates/live/", 1), ("crates/simulator/", 1), ("crates/workbench/", 2), ("examples/", 2), ("", 0))
# Packages that may use these of a later ring.
EXCEPTIONS = {
    "fmus": {"motorcycle", "stewart-platform"},
    "build-fmu": {"motorcycle", "stewart-platform"},
}
OUTSIDE = ("examples/0", "fuzz/", "tests/importers/")


def packages():
    """Each package of the workspace by its name without `moris-`: its folder, and the packages that it uses."""
    found = {}
    # Other tests make packages in the folder of the build, and remove them.
    parts = [part for part in ROOT.iterdir() if part.is_dir() and part.name != "target"]
    for manifest in sorted([ROOT / "Cargo.toml", *(manifest for part in parts for manifest in part.glob("**/Cargo.toml"))]):
        folder = manifest.parent.relative_to(ROOT).as_posix() + "/"
        table = tomllib.loads(manifest.read_text())
        if folder.startswith(OUTSIDE) or "package" not in table:
            continue
        sections = [table, *table.get("target", {}).values()]
        uses = {short(name) for section in sections for name in section.get("dependencies", {}) if name.startswith("moris")}
        found[short(table["package"]["name"])] = folder, uses
    return found


def short(name):
    return name.removeprefix("moris-")


def ring(folder):
    return next(ring for path, ring in RINGS if folder.startswith(path))


def test_a_package_uses_its_own_ring_and_those_before():
    found = packages()
    assert len(found) > 20
    for name, (folder, uses) in found.items():
        excepted = EXCEPTIONS.get("fmus" if folder.startswith("crates/fmus/") else name, set())
        later = {used for used in uses if ring(found[used][0]) > ring(folder)}
        assert later <= excepted, f"{name} uses {later - excepted} of a later ring"


def test_the_table_of_uses_has_what_the_manifests_have():
    section = (ROOT / "ARCHITECTURE.md").read_text().partition("| package | uses |")[2].partition("\n\n")[0]
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", section, re.MULTILINE)
    table = {name: uses for names, uses in rows for name in re.findall(r"`([\w*/-]+)`", names)}
    found = packages()
    for name, text in table.items():
        if name == "fmus/*":
            continue
        # What a package's tests use, or it compiles by calling cargo, comes after a semicolon; reasons are in parentheses.
        named = set(re.findall(r"`([\w-]+)`", re.sub(r"\(.*?\)", "", text.partition(";")[0])))
        named |= {"motorcycle", "stewart-platform", "washout"} if "the three models" in text else set()
        name = {"modelDescription": "model-description"}.get(name, name)
        named = {{"modelDescription": "model-description"}.get(used, used) for used in named}
        folder, uses = found[name]
        assert named == uses, f"{name}: the table has {named}, the manifest {uses}"
    assert {"fmu-host", "washout", "moris", "python"} <= table.keys()


def test_analysis_and_simulation_know_no_command_line():
    """What the command and Python share prints nothing; clap is there for the command alone, as a feature."""
    shown = {"clap", "clap_complete", "clap_mangen", "ctrlc", "httparse", "indicatif", "moris", "moris-live", "pyo3", "rtrb"}
    for name in ("analysis", "pages", "simulation"):
        table = tomllib.loads((ROOT / "crates" / "workbench" / name / "Cargo.toml").read_text())
        features = table.get("features", {})
        by_default = {of for feature in features.get("default", []) for of in features[feature]}
        optional = {one for one, of in table["dependencies"].items() if of.get("optional") and f"dep:{one}" not in by_default}
        assert not (table["dependencies"].keys() - optional) & shown, name
        for file in (ROOT / "crates" / "workbench" / name / "src").glob("**/*.rs"):
            assert not re.search(r"\be?print(ln)?!|\bstd::net\b|IsTerminal", file.read_text()), file
    for file in (ROOT / "crates" / "workbench" / "simulation" / "src" / "measures").glob("**/*.rs"):
        # Beside the reason why there are none.
        used = re.findall(r"crate::(?!Refusal;|\{Refusal, refuse\};)", file.read_text())
        assert not used, f"{file}: measures are made of series alone, and know no replay"
    html = {"moris-pages", "base64"}
    table = tomllib.loads((ROOT / "crates" / "workbench" / "simulation" / "Cargo.toml").read_text())
    assert not table["dependencies"].keys() & html
    assert "moris" not in packages()["python"][1]


# Comments, and literals of text and of characters, in Rust.
RUST = re.compile(r"""//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|"(?:\\.|[^"\\])*"|'(?:\\.[^']*|[^'\\])'""", re.DOTALL)


def test_analysis_leaves_the_words_for_options_to_the_faces():
    """The text of an error or a warning has no option of the command, and no sign in place of one: remedies are data."""
    for file in (ROOT / "crates" / "workbench" / "analysis" / "src").glob("**/*.rs"):
        for literal in (found[0] for found in RUST.finditer(file.read_text())):
            if not literal.startswith("/"):
                assert not re.search(r"--[a-z]|\\u\{fdd|[\ufdd0-\ufdef]", literal, re.IGNORECASE), f"{file}: {literal}"


def compiled(*selection):
    """Packages with their features, as cargo compiles them for a selection."""
    command = ["cargo", "tree", "--locked", "--prefix", "none", "--format", "{p}|{f}", *selection]
    printed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return {re.sub(r" \(.*?\)", "", line) for line in printed.splitlines()}


def test_the_python_package_as_tested_takes_each_library_as_the_tests_in_rust_have_compiled_it():
    everything = compiled("--workspace", "--edges", "normal,build,dev")
    package = compiled("--package", "moris-python", "--features", "as-tested", "--edges", "normal,build")
    assert len(package) > 100
    anew = {one for one in package - everything if not one.startswith("moris-python ")}
    assert not anew, "add these features to tests/fmu-tests/Cargo.toml"


def test_packages_with_unsafe_code_keep_debug_assertions():
    """They check what `unsafe` code promises. The functions that a macro exports are compiled where it is called."""
    profiles = tomllib.loads((ROOT / "Cargo.toml").read_text())["profile"]["dev"]["package"]
    kept = {short(name) for name, profile in profiles.items() if profile.get("debug-assertions")}
    folders = {name: ROOT / folder for name, (folder, _) in packages().items() if folder != "./"}
    files = {name: [*folder.glob("**/*.rs")] for name, folder in folders.items()}
    unsafe = re.compile(r"\bunsafe (\{|extern|fn|impl)|export_fmi[23]!")
    needed = {name for name in files if any(unsafe.search(file.read_text()) for file in files[name])}
    assert {"fmi", "fmu-host", "board"} <= needed <= kept, f"{needed - kept}: debug-assertions = true in Cargo.toml's profile"
