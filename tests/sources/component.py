"""Steps the WebAssembly component in an FMU over the reference ride in wasmtime, and prints the outputs after each step.

    component.py FMU SETTINGS

SETTINGS are items of enumerations by name, in JSON. Before the ride, refusals are checked, and in its middle a saved state.
"""

import json
import sys
import zipfile
from pathlib import Path

from wasmtime import Engine, Store
from wasmtime.component import Component, Linker

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "importers"))
from ride import Ride  # noqa: E402

# All that the component may import: neither files nor clocks.
IMPORTS = {"fmi:fmi3/types@3.0.0", "fmi:fmi3/callbacks@3.0.0"}
CLASS = "co-simulation-instance"


class Host:
    """The component's functions, and the messages that it has sent."""

    def __init__(self, code):
        engine = Engine()
        component = Component(engine, code)
        imports = set(component.type.imports(engine))
        assert imports == IMPORTS, f"the component imports {imports - IMPORTS}"
        self.store, self.messages, linker = Store(engine), [], Linker(engine)
        with linker.root() as root:
            with root.add_instance("fmi:fmi3/types@3.0.0"):
                pass
            with root.add_instance("fmi:fmi3/callbacks@3.0.0") as callbacks:
                callbacks.add_func("log-message", lambda _, *message: self.messages.append(message))
        self.component = linker.instantiate(self.store, component)
        self.functions = {}

    def call(self, interface, name, *arguments):
        if name not in self.functions:
            within = self.component.get_export_index(self.store, f"fmi:fmi3/{interface}@3.0.0")
            index = self.component.get_export_index(self.store, name, within)
            self.functions[name] = self.component.get_func(self.store, index)
        result = self.functions[name](self.store, *arguments)
        self.functions[name].post_return(self.store)
        return result

    def instantiate(self, token):
        arguments = ("ride", token, "", False, False, False, False, [])
        return self.call("co-simulation", f"[static]{CLASS}.instantiate-co-simulation", *arguments)

    def method(self, instance, name, *arguments):
        return self.call("co-simulation", f"[method]{CLASS}.{name}", instance, *arguments)


def main():
    fmu, settings = sys.argv[1], json.loads(sys.argv[2])
    ride = Ride(fmu)
    with zipfile.ZipFile(fmu) as archive:
        assert "extra/org.modelica.fmi-ls-wasm/manifest.xml" in archive.namelist(), "the FMU has no manifest"
        host = Host(archive.read(f"binaries/wasm32-wasip2/{ride.model}.wasm"))
    assert host.call("common", "get-version") == "3.0"
    assert host.instantiate("of another FMU") is None, "another FMU's token is accepted"
    assert host.messages[-1][:3] == ("ride", "error", "logStatusError"), host.messages
    instance = host.instantiate(ride.guid)
    do = lambda name, *arguments: host.method(instance, name, *arguments)
    succeed = lambda name, *arguments: check(do(name, *arguments), name)

    for name, arguments in {
        "do-step": (0.0, 0.01, False),
        "get-float64": ([2**32 - 1],),
        "get-clock": ([0],),
        "get-string": ([0],),
        "set-string": ([0, 1], ["some", "text"]),
        "set-input-derivatives": ([(0, 1)], [1.0]),
        "update-discrete-states": (),
        "get-number-of-variable-dependencies": (0,),
        "get-directional-derivative": ([0], [1], [1.0]),
        "set-fmu-state": (b"no state",),
        "set-debug-logging": (True, ["no category"]),
    }.items():
        before = len(host.messages)
        status = do(name, *arguments)
        assert status == "error" and len(host.messages) == before + 1, f"{name}: {status}, {host.messages[before:]}"
    assert "no variables of this type" in [text for *_, text in host.messages if "SetString" in text][0], host.messages

    for name, item in settings.items():
        succeed("set-int64", [ride.references[name]], [item])
    succeed("enter-initialization-mode", None, 0.0, None)
    succeed("exit-initialization-mode")
    inputs, outputs = ([ride.references[name] for name in names] for names in (ride.inputs, ride.outputs))

    def step(k):
        succeed("set-float64", inputs, ride.input(k))
        result = do("do-step", ride.time(k), ride.step, True)
        assert abs(getattr(result, "last-successful-time") - ride.time(k + 1)) < 1e-9, f"step {k}: {result}"
        return do("get-float64", outputs)

    for k in range(ride.steps):
        if k == ride.steps // 2:
            state = do("get-fmu-state")
            expected = [step(k), step(k + 1)]
            succeed("set-fmu-state", state)
            assert [step(k), step(k + 1)] == expected, "other numbers after a return to a state"
            succeed("set-fmu-state", state)
        print(*map(repr, step(k)))
    succeed("terminate")
    instance.drop(host.store)


def check(status, name):
    assert status == "ok", f"{name}: {status}"


if __name__ == "__main__":
    main()
