"""Simulates the FMU of the low-pass in FMPy: the response to a step of 1 m/s².

    cargo run --bin moris-07_own_model_as_fmu
    python3 examples/07_own_model_as_fmu/simulate.py

Draws `target/examples/07_own_model_as_fmu.svg`.
"""

import sys
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

sys.path.append(str(Path(__file__).parents[1]))
from picture import BLUE, GREY, draw

FMU = "target/fmu/LowPass.fmu"

print("problems of the model description:", validate_fmu(FMU) or "none")
step = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (3.0, 1.0)], dtype=[("time", float), ("u", float)])
result = simulate_fmu(FMU, input=step, stop_time=3, output_interval=0.01, start_values={"tau": 0.4})
print(f"y one time constant after the step: {np.interp(1.4, result['time'], result['y']):.3f} m/s²")
draw("target/examples/07_own_model_as_fmu.svg", "A model of your own as an FMU", result["time"], [
    ("specific force [m/s²]", [("u", np.interp(result["time"], step["time"], step["u"]), GREY), ("y", result["y"], BLUE)]),
])
