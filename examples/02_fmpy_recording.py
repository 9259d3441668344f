"""Simulates a recording with the FMU in FMPy: one call.

    cargo build-fmu
    python3 examples/02_fmpy_recording.py

A recording is an array with the columns `time` and the FMU's inputs. This one is computed: the acceleration rises
to 1.5 m/s² within 2 s and goes back to zero, twice as fast. Inputs that it lacks keep their start values. Draws
`target/examples/02_fmpy_recording.svg`.
"""

import io
from contextlib import redirect_stdout

import numpy as np
from fmpy import read_model_description, simulate_fmu
from picture import BLUE, GREY, draw

time = np.linspace(0, 20, 2001)
surge = np.interp(time, [1, 3, 10, 11], [0, 1.5, 1.5, 0])
recording = np.rec.fromarrays([time, surge], names=["time", "vehicle.specificForce.x"])

lengths = [f"actuator[{i}].length" for i in range(1, 7)]
outputs = ["rider.specificForce.x", *lengths]
fmu = "target/fmu/MorisWashout.fmu"
inputs = {variable.name for variable in read_model_description(fmu).modelVariables if variable.causality == "input"}
# FMPy ignores other columns.
assert set(recording.dtype.names) <= {"time", *inputs}
try:
    with redirect_stdout(io.StringIO()) as printed:
        result = simulate_fmu(fmu, input=recording, output=outputs, stop_time=20, output_interval=0.001)
finally:
    # What the FMU warns of, without FMPy's line for each input that the recording lacks.
    print("".join(line for line in printed.getvalue().splitlines(True) if "missing input" not in line), end="")

desired, felt = np.interp(result["time"], time, surge), result["rider.specificForce.x"]
print(f"RMS error of the felt specific force: {np.sqrt(np.mean((felt - desired) ** 2)):.3f} m/s²")
print(f"actuators: {min(result[l].min() for l in lengths):.3f} to {max(result[l].max() for l in lengths):.3f} m")
draw("target/examples/02_fmpy_recording.svg", "A recording, simulated with FMPy", result["time"], [
    ("specific force, surge [m/s²]", [("desired", desired, GREY), ("felt", felt, BLUE)]),
    ("actuator length [m]", [(f"{i}", result[f"actuator[{i}].length"], None) for i in range(1, 7)] + [(None, 1.0, None), (None, 1.6, None)]),
])
