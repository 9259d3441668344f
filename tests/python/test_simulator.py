"""The whole simulator as an SSP: its schemas, that its wiring fits the FMUs in it, and the documented ride."""

import io
import os
import subprocess
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from conftest import ANGLES, AXES, ROOT, TARGET, example, only_all_cases
from fmpy import read_model_description
from fmpy.ssp.simulation import simulate_ssp
from lxml import etree

ENDS = ("startElement", "startConnector", "endElement", "endConnector")
SCHEMAS = Path(fmpy.__file__).parent / "ssp" / "schema"
NAMESPACES = {
    part: f"http://ssp-standard.org/SSP1/SystemStructure{name}"
    for part, name in (("ssd", "Description"), ("ssc", "Common"), ("ssv", "ParameterValues"))
}


@pytest.fixture(scope="module")
def ssp():
    path = Path(os.environ.get("MORIS_SSP", TARGET / "fmu" / "MotorcycleSimulator.ssp"))
    assert path.exists(), f"{path} is missing: run `cargo build-ssp`"
    return path


def file(ssp, name):
    with zipfile.ZipFile(ssp) as archive:
        return archive.read(name)


@pytest.fixture(scope="module")
def system(ssp):
    return etree.fromstring(file(ssp, "SystemStructure.ssd"))


@pytest.fixture(scope="module")
def parameters(ssp, system):
    (source,) = system.xpath("ssd:System/ssd:ParameterBindings/ssd:ParameterBinding/@source", namespaces=NAMESPACES)
    return etree.fromstring(file(ssp, source))


@pytest.fixture(scope="module")
def models(ssp, system):
    """The variables of each component's FMU, by name."""
    found = {}
    for component in system.xpath("//ssd:Component", namespaces=NAMESPACES):
        description = read_model_description(io.BytesIO(file(ssp, component.get("source"))))
        found[component.get("name")] = {variable.name: variable for variable in description.modelVariables}
    return found


@pytest.fixture(scope="module")
def flat(ssp):
    path = ssp.with_suffix(".flat.ssp")
    assert path.exists(), f"{path} is missing: run `cargo build-ssp --flat`"
    return path


def test_the_flat_one_is_the_same_without_inputs_and_with_a_parameter_set_a_component(system, parameters, flat):
    root = etree.fromstring(file(flat, "SystemStructure.ssd"))
    etree.XMLSchema(file=str(SCHEMAS / "SystemStructureDescription.xsd")).assertValid(root)
    assert not root.xpath("ssd:System/ssd:Connectors", namespaces=NAMESPACES)

    def wires(root):
        between = "//ssd:Connection[@startElement and @endElement]"
        return [dict(w.attrib) for w in root.xpath(between, namespaces=NAMESPACES)]

    assert wires(root) == wires(system) == [dict(w.attrib) for w in root.xpath("//ssd:Connection", namespaces=NAMESPACES)]
    values = {}
    for component in root.xpath("//ssd:Component[ssd:ParameterBindings]", namespaces=NAMESPACES):
        (source,) = component.xpath("ssd:ParameterBindings/ssd:ParameterBinding/@source", namespaces=NAMESPACES)
        own = etree.fromstring(file(flat, source))
        etree.XMLSchema(file=str(SCHEMAS / "SystemStructureParameterValues.xsd")).assertValid(own)
        for parameter in own.xpath("ssv:Parameters/ssv:Parameter", namespaces=NAMESPACES):
            values[f"{component.get('name')}.{parameter.get('name')}"] = dict(parameter[0].attrib)
    whole = parameters.xpath("ssv:Parameters/ssv:Parameter", namespaces=NAMESPACES)
    assert values == {parameter.get("name"): dict(parameter[0].attrib) for parameter in whole}


@pytest.fixture(scope="module")
def laps(ssp):
    """The lap in both forms."""
    paths = [ssp.with_name(f"MotorcycleLap.{form}") for form in ("ssp", "flat.ssp")]
    for path in paths:
        assert path.exists(), f"{path} is missing: run `cargo build-ssp --system MotorcycleLap`, with --flat too"
    return paths


def wires(root):
    return {tuple(wire.get(part) for part in ENDS) for wire in root.xpath("//ssd:Connection", namespaces=NAMESPACES)}


def test_the_lap_is_the_simulator_without_inputs_and_with_the_preview(laps, system):
    schema = etree.XMLSchema(file=str(SCHEMAS / "SystemStructureDescription.xsd"))
    whole, flat = (etree.fromstring(file(path, "SystemStructure.ssd")) for path in laps)
    for root in (whole, flat):
        schema.assertValid(root)
        assert not root.xpath("//ssd:ParameterBinding", namespaces=NAMESPACES)
    forces = [f"specificForce.{axis}[{k}]" for axis in "xy" for k in range(1, 21)]
    names = [f"vehicle.preview.{name}" for name in ("count", "step", *forces)]
    previews = {("motorcycle", name, "washout", name) for name in names}
    assert wires(whole) == {wire for wire in wires(system) if wire[0] is not None} | previews
    assert wires(flat) == {wire for wire in wires(whole) if wire[2] is not None}
    kinds = whole.xpath("ssd:System/ssd:Connectors/ssd:Connector/@kind", namespaces=NAMESPACES)
    assert set(kinds) == {"output"}


def test_the_laps_fmus_start_with_its_parameters_and_have_its_connectors(laps):
    for path in laps:
        root = etree.fromstring(file(path, "SystemStructure.ssd"))
        starts = {}
        for component in root.xpath("//ssd:Component", namespaces=NAMESPACES):
            description = read_model_description(io.BytesIO(file(path, component.get("source"))))
            variables = {variable.name: variable for variable in description.modelVariables}
            starts[component.get("name")] = variables
            for connector in component.xpath("ssd:Connectors/ssd:Connector", namespaces=NAMESPACES):
                variable, (kind,) = variables[connector.get("name")], connector
                assert variable.causality == connector.get("kind")
                assert (etree.QName(kind).localname, kind.get("unit")) == (variable.type, variable.unit)
        assert starts["motorcycle"]["path.course"].start == "6"
        assert starts["washout"]["strategy"].start == "4"
        assert float(starts["washout"]["scale.angularVelocity.x"].start) == 0.1


@only_all_cases
def test_the_example_rides_the_lap_near_its_preview(laps):
    lap = example("10_lap")
    result = lap.simulate(laps[0], 2e-3, 15.0)
    assert result["speed"].max() > 20.0 and np.abs(result["motorcycle.path.deviation"]).max() < 0.1
    (rest, surge), _ = lap.errors(result)
    assert surge < 0.5 * rest
    assert not np.any(result["actuatorLimited"])
    # From 1.5 s on the preview is whole, and element k is the force k times the step later.
    desired = result["motorcycle.vehicle.specificForce.x"]
    for k in (1, 5, 20):
        previewed = result[f"motorcycle.vehicle.preview.specificForce.x[{k}]"]
        later = np.interp(result["time"] + 0.2 * k, result["time"], desired)
        settled = (result["time"] > 1.5) & (result["time"] < 10.0)
        assert np.max(np.abs(previewed - later)[settled]) < 0.05


def test_an_own_vehicle_takes_the_place_of_the_motorcycle(ssp, tmp_path):
    command = ["cargo", "build-ssp", "--vehicle", str(ssp.with_name("Motorcycle.fmu")), "--output", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    package = tmp_path / "OwnVehicle.ssp"
    root = etree.fromstring(file(package, "SystemStructure.ssd"))
    etree.XMLSchema(file=str(SCHEMAS / "SystemStructureDescription.xsd")).assertValid(root)
    result = simulate_ssp(str(package), stop_time=0.5, step_size=1e-3)
    assert abs(result["vehicle.vehicle.specificForce.z"][-1] - 9.80665) < 1e-3
    assert abs(result["washout.vehicle.specificForce.z"][-1] - 9.80665) < 1e-3
    assert all(1.0 <= result[f"platform.command[{k}].length"][-1] <= 1.6 for k in range(1, 7))


def test_it_is_valid_against_the_schemas_of_ssp_1_0(system, parameters):
    for root, schema in ((system, "SystemStructureDescription.xsd"), (parameters, "SystemStructureParameterValues.xsd")):
        assert root.get("version") == "1.0"
        etree.XMLSchema(file=str(SCHEMAS / schema)).assertValid(root)


def units(root, part):
    """A file's definitions of units: exponents by name."""
    found = {}
    for unit in root.xpath(f"{part}:Units/ssc:Unit", namespaces=NAMESPACES):
        (base,) = unit
        assert unit.get("name") not in found
        found[unit.get("name")] = dict(base.attrib)
    return found


def test_every_connector_is_a_variable_of_its_fmu_with_its_unit(ssp, system, models):
    defined = units(system, "ssd")
    for component in system.xpath("//ssd:Component", namespaces=NAMESPACES):
        variables = models[component.get("name")]
        connectors = component.xpath("ssd:Connectors/ssd:Connector", namespaces=NAMESPACES)
        assert len(connectors) > 10
        for connector in connectors:
            variable = variables[connector.get("name")]
            assert variable.causality == connector.get("kind")
            (kind,) = connector
            assert etree.QName(kind).localname == variable.type
            assert kind.get("unit") == variable.unit and (variable.unit is None or variable.unit in defined)
        description = etree.fromstring(zipfile.ZipFile(io.BytesIO(file(ssp, component.get("source")))).read("modelDescription.xml"))
        for unit in description.iter("Unit"):
            assert defined[unit.get("name")] == dict(unit.find("BaseUnit").attrib)


def test_the_washout_gets_the_motorcycle_and_the_platform_gets_the_washout(system, models):
    ends = [
        tuple(connection.get(part) for part in ("startElement", "startConnector", "endElement", "endConnector"))
        for connection in system.xpath("//ssd:Connection", namespaces=NAMESPACES)
    ]
    vectors = [(name, AXES) for name in ("vehicle.specificForce", "vehicle.angularVelocity")]
    delivered = [f"{name}.{part}" for name, parts in [*vectors, ("vehicle.orientation", ANGLES)] for part in parts]
    expected = {("motorcycle", name, "washout", name) for name in [*delivered, "vehicle.speed", "rider.lean"]}
    expected |= {
        ("washout", f"actuator[{i}].{quantity}", "platform", f"command[{i}].{quantity}")
        for i in range(1, 7)
        for quantity in ("length", "velocity")
    }
    expected |= {("motorcycle", "rider.lean", "platform", "rider.lean")}
    expected |= {(None, name, "motorcycle", f"command.{name}") for name in ("throttle", "brake", "lean")}
    felt = [("SpecificForce", "specificForce"), ("AngularVelocity", "angularVelocity")]
    expected |= {
        ("platform", f"rider.{vector}.{axis}", None, f"felt{name}{axis.upper()}") for name, vector in felt for axis in AXES
    }
    expected |= {("platform", f"actuator[{i}].length", None, f"actuatorLength{i}") for i in range(1, 7)}
    expected |= {("motorcycle", "vehicle.speed", None, "speed")}
    washout = ("strokeMargin", "tiltLimited", "safetyActive", "actuatorLimited")
    platform = ("commandRefused", "driveLimited", "forceLimited", "atStop")
    for component, names in (("washout", washout), ("platform", platform)):
        expected |= {(component, f"status.{name}", None, name) for name in names}
    assert sorted(map(str, ends)) == sorted(map(str, expected))
    for start, output, end, name in ends:
        if start is not None and end is not None:
            assert models[start][output].unit == models[end][name].unit
    # Every input that is a connector has its connection, and nothing of the platform's or the washout's is left open but this.
    preview = {name for name in models["washout"] if name.startswith("vehicle.preview.")}
    # The packages' rig has legs: the commands of cranks are for other rigs.
    cranks = {f"command[{i}].{quantity}" for i in range(1, 7) for quantity in ("angle", "angularVelocity")}
    for component, left in (("washout", {"engaged"} | preview), ("platform", cranks)):
        inputs = {name for name, variable in models[component].items() if variable.causality == "input"}
        assert inputs - {name for _, _, end, name in ends if end == component} == left


def test_the_system_has_inputs_and_outputs_that_are_identifiers_with_their_units(system, models):
    connections = system.xpath("//ssd:Connection", namespaces=NAMESPACES)
    connectors = system.xpath("ssd:System/ssd:Connectors/ssd:Connector", namespaces=NAMESPACES)
    assert [connector.get("kind") for connector in connectors].count("input") == 3
    for connector in connectors:
        name, (kind,) = connector.get("name"), connector
        assert name.isidentifier()
        inward = [(c.get("endElement"), c.get("endConnector")) for c in connections if c.get("startElement") is None and c.get("startConnector") == name]
        outward = [(c.get("startElement"), c.get("startConnector")) for c in connections if c.get("endElement") is None and c.get("endConnector") == name]
        ((component, variable),) = inward if connector.get("kind") == "input" else outward
        variable = models[component][variable]
        assert variable.causality == connector.get("kind")
        assert (etree.QName(kind).localname, kind.get("unit")) == (variable.type, variable.unit), name


def test_every_parameter_is_one_of_its_fmu_with_its_unit(parameters, models):
    defined = units(parameters, "ssv")
    found = parameters.xpath("ssv:Parameters/ssv:Parameter", namespaces=NAMESPACES)
    assert found
    for parameter in found:
        component, name = parameter.get("name").split(".", 1)
        variable = models[component][name]
        assert variable.causality == "parameter"
        (value,) = parameter
        assert etree.QName(value).localname == variable.type
        if variable.type == "Real":
            float(value.get("value"))
            assert value.get("unit") == variable.unit and (variable.unit is None or variable.unit in defined)


@only_all_cases
def test_the_example_accelerates_slaloms_and_stops_with_the_legs_well_in_stroke(ssp):
    whole = example("06_whole_simulator")
    result = whole.simulate(ssp, 2e-3)
    time, speed = result["time"], result["motorcycle.vehicle.speed"]
    assert speed[0] == 0.0 and speed.max() > 20.0
    assert np.all(speed[time > 40.0] == 0.0) and np.all(speed >= 0.0)
    lean = np.degrees(result["motorcycle.vehicle.orientation.roll"])
    assert lean.max() > 12.0 and lean.min() < -12.0
    lengths = whole.legs(result, "platform", "length")
    # The system's outputs are the components' variables.
    assert np.array_equal(result["speed"], speed)
    assert np.array_equal(result["actuatorLength3"], lengths[:, 2])
    assert np.array_equal(result["feltAngularVelocityX"], result["platform.rider.angularVelocity.x"])
    assert not np.any(result["safetyActive"])
    assert lengths.min() > 1.09 and lengths.max() < 1.58
    assert np.ptp(lengths) > 0.25
    for status in (
        "washout.status.safetyActive", "washout.status.actuatorLimited", "platform.status.commandRefused",
        "platform.status.driveLimited", "platform.status.forceLimited", "platform.status.atStop",
    ):  # fmt: skip
        assert not np.any(result[status]), status

    def correlation(quantity, felt_quantity, during):
        vehicle, felt = result[f"motorcycle.vehicle.{quantity}"], result[f"platform.rider.{felt_quantity}"]
        return np.corrcoef(vehicle[during], felt[during])[0, 1]

    slalom = (time > 14.0) & (time < 30.0)
    assert correlation("specificForce.x", "specificForce.x", time > 0) > 0.85
    assert correlation("specificForce.y", "specificForce.y", slalom) > 0.9
    # The felt force has the scaled size, because the tilt takes back what roll would add. What is left of the roll rate
    # has the right sign.
    desired, felt = 0.65 * result["motorcycle.vehicle.specificForce.y"][slalom], result["platform.rider.specificForce.y"][slalom]
    assert np.sqrt(np.mean((felt - desired) ** 2)) < 0.3 * np.sqrt(np.mean(desired**2))
    assert correlation("angularVelocity.x", "angularVelocity.x", slalom) > 0.2
    # The platform is where it was commanded, but for the delay of its drives.
    late = 0.004 + 2 * np.sqrt(0.5) / 62.83 + 2e-3
    for i in range(1, 7):
        commanded = np.interp(time - late, time, result[f"washout.actuator[{i}].length"])
        assert np.max(np.abs(commanded - result[f"platform.actuator[{i}].length"])) < 1e-3
