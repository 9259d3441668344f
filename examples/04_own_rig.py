"""Simulates a recording on a rig of your own: its geometry and limits as start values of the FMU.

    cargo build-fmu
    python3 examples/04_own_rig.py

The file `examples/04_own_rig.toml` has the rig. `cargo moris rig check examples/04_own_rig.toml` checks it and draws
its workspace; `cargo build-fmu --rig examples/04_own_rig.toml` embeds it in an FMU. Draws
`target/examples/04_own_rig.svg`.
"""

import io
from contextlib import redirect_stdout
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from picture import BLUE, GREY, ORANGE, draw

try:
    import tomllib
except ImportError:  # Python 3.10
    import tomli as tomllib

rig = tomllib.loads(Path("examples/04_own_rig.toml").read_text())
start_values = {
    "rig.neutralHeight": rig["neutralHeight"],
    "head.height": rig["head"]["height"],
    **{f"actuator.{name}": value for name, value in rig["actuator"].items()},
    **{f"safety.{axis}.positionLimit": limit for axis, limit in zip("xyz", rig["safety"]["positionLimit"])},
}
for part in ("base", "platform"):
    angles = np.radians(rig[part]["degrees"])
    for i, angle in enumerate(angles, 1):
        start_values[f"rig.{part}[{i}].x"] = rig[part]["radius"] * np.cos(angle)
        start_values[f"rig.{part}[{i}].y"] = rig[part]["radius"] * np.sin(angle)
        start_values[f"rig.{part}[{i}].z"] = 0.0

time = np.linspace(0, 30, 3001)
surge = np.interp(time, [1, 3, 12, 13, 16, 17, 25, 26], [0, 1.5, 1.5, 0, 0, -3, -3, 0])
recording = np.rec.fromarrays([time, surge], names=["time", "vehicle.specificForce.x"])
lengths = [f"actuator[{i}].length" for i in range(1, 7)]
outputs = ["rider.specificForce.x", "status.strokeMargin", *lengths]
options = dict(input=recording, output=outputs, stop_time=30, output_interval=0.001)
try:
    with redirect_stdout(io.StringIO()) as printed:
        own = simulate_fmu("target/fmu/MorisWashout.fmu", start_values=start_values, **options)
        default = simulate_fmu("target/fmu/MorisWashout.fmu", **options)
finally:
    # What the FMU warns of, without FMPy's line for each input that the recording lacks.
    print("".join(line for line in printed.getvalue().splitlines(True) if "missing input" not in line), end="")


def stroke(result, shortest, longest):
    return [(f"{i}", result[f"actuator[{i}].length"], None) for i in range(1, 7)] + [(None, shortest, None), (None, longest, None)]


print(f"smallest stroke margin: {own['status.strokeMargin'].min():.3f} m, default rig {default['status.strokeMargin'].min():.3f} m")
draw("target/examples/04_own_rig.svg", "One recording on two rigs", own["time"], [
    ("specific force,\nsurge [m/s²]", [
        ("desired", np.interp(own["time"], time, surge), GREY),
        ("felt, default rig", default["rider.specificForce.x"], ORANGE),
        ("felt, own rig", own["rider.specificForce.x"], BLUE),
    ]),
    ("actuator length,\nown rig [m]", stroke(own, rig["actuator"]["minLength"], rig["actuator"]["maxLength"])),
    ("actuator length,\ndefault rig [m]", stroke(default, 1.0, 1.6)),
])
