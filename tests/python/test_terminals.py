"""The FMUs' terminals: valid by FMI 3.0's schema, made of variables that exist, and fitting each other."""

import zipfile
from pathlib import Path

import fmpy
import pytest
from conftest import TARGET, stated
from fmpy import read_model_description
from lxml import etree

SCHEMA = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"
MODELS = ["MorisWashout", "Motorcycle", "StewartPlatform"]
KINDS = ["fmu", "fmi3.fmu", "fmi3.arrays.fmu"]
# From an output terminal to an input terminal: a line each.
LINES = [
    ("Motorcycle", "vehicle", "MorisWashout", "vehicle"),
    ("MorisWashout", "actuators", "StewartPlatform", "actuators"),
    ("Motorcycle", "rider", "StewartPlatform", "rider"),
]
# Where the motorcycle follows a path, as on the lap.
PREVIEW = ("Motorcycle", "preview", "MorisWashout", "preview")


def fmu(model, kind):
    folder = TARGET / "fmu"
    # FMUs of FMI 2.0 have them on request.
    path = (folder / "terminals" if kind == "fmu" else folder) / f"{model}.{kind}"
    assert path.exists(), f"{path} is missing: run `python3 tests/run.py --only fmu`"
    return path


def root(path):
    with zipfile.ZipFile(path) as archive:
        return etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))


def terminals(path):
    """The variables of each terminal by the names of its members, with the terminal's kind and rule."""
    variables = {v.name: v for v in read_model_description(path).modelVariables}
    found = {}
    for terminal in root(path).iterfind("Terminals/Terminal"):
        members = terminal.findall("TerminalMemberVariable")
        assert all(member.get("variableKind") == "signal" for member in members)
        by_name = {member.get("memberName"): variables[member.get("variableName")] for member in members}
        assert len(by_name) == len(members)
        found[terminal.get("name")] = ((terminal.get("terminalKind"), terminal.get("matchingRule")), by_name)
    return found


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("model", MODELS)
def test_the_file_is_valid_and_names_variables_of_one_causality(model, kind):
    path = fmu(model, kind)
    etree.XMLSchema(file=str(SCHEMA)).assertValid(root(path))
    found = terminals(path)
    assert len(found) >= 2
    for name, (_, members) in found.items():
        assert len({variable.causality for variable in members.values()}) == 1, name
        assert {variable.causality for variable in members.values()} <= {"input", "output"}, name
    assert all(terminal.get("terminalKind").startswith("_moris.") for terminal in root(path).iterfind("Terminals/Terminal"))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("source, output, target, input", [*LINES, PREVIEW])
def test_terminals_fit_member_by_member(source, output, target, input, kind):
    (kind_from, members_from) = terminals(fmu(source, kind))[output]
    (kind_to, members_to) = terminals(fmu(target, kind))[input]
    assert kind_from == kind_to and members_from.keys() == members_to.keys()
    for name in members_from:
        start, end = members_from[name], members_to[name]
        assert (start.causality, end.causality) == ("output", "input"), name
        assert (start.type, start.shape) == (end.type, end.shape), name
        assert stated(start, "unit") == stated(end, "unit"), name


@pytest.mark.parametrize("system, lines", [("MotorcycleSimulator", LINES), ("MotorcycleLap", [*LINES, PREVIEW])])
def test_the_lines_are_all_connections_of_a_system(system, lines):
    with zipfile.ZipFile(TARGET / "fmu" / f"{system}.ssp") as archive:
        system = etree.fromstring(archive.read("SystemStructure.ssd"))
    names = {"motorcycle": "Motorcycle", "washout": "MorisWashout", "platform": "StewartPlatform"}
    ssd = {"ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription"}
    wired = {
        (names[c.get("startElement")], c.get("startConnector"), names[c.get("endElement")], c.get("endConnector"))
        for c in system.iterfind(".//ssd:Connection", ssd)
        if c.get("startElement") and c.get("endElement")
    }
    joined = set()
    for source, output, target, input in lines:
        outputs, inputs = terminals(fmu(source, "fmu"))[output][1], terminals(fmu(target, "fmu"))[input][1]
        joined |= {(source, outputs[name].name, target, inputs[name].name) for name in outputs}
    assert joined == wired
