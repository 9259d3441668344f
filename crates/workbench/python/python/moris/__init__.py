"""Motion cueing: the MORIS washout filter, the quality of its cues, and its tuning.

Frames: x forward, y left, z up; roll, pitch and yaw about x, y and z, so that positive pitch is nose down. All quantities
are in SI units. Variables have the names that they have in the FMU.
"""

from ._compare import Comparison, compare
from ._errors import BoundError, BuildError, ExecutorError, MorisError, NoFeasibleParameters, ParameterError, RecordingError
from ._fit import AxisShape, Candidate, Fit, fit
from ._fmu import build_fmu
from ._judged import measure
from ._measures import Measure, Measures
from ._moris import VERSION as __version__
from ._moris import Output, Washout, presets, rigs
from ._outputs import Outputs
from ._recording import Recording
from ._response import FrequencyResponse, frequency_response
from ._simulation import Bound, Simulation, bound, parameters, simulate, write_parameters
from ._survey import AxisReach, Survey, survey
from ._sweep import MEASURES, Result, Sweep, best, sweep
from ._tune import Tuned, tune
from ._variables import Variable, variables

__all__ = [
    "AxisReach",
    "AxisShape",
    "Bound",
    "BoundError",
    "BuildError",
    "Candidate",
    "Comparison",
    "ExecutorError",
    "Fit",
    "FrequencyResponse",
    "MEASURES",
    "Measure",
    "Measures",
    "MorisError",
    "NoFeasibleParameters",
    "Output",
    "Outputs",
    "ParameterError",
    "Recording",
    "RecordingError",
    "Result",
    "Simulation",
    "Survey",
    "Sweep",
    "Tuned",
    "Variable",
    "Washout",
    "__version__",
    "best",
    "bound",
    "build_fmu",
    "compare",
    "fit",
    "frequency_response",
    "measure",
    "parameters",
    "presets",
    "rigs",
    "simulate",
    "survey",
    "sweep",
    "tune",
    "variables",
    "write_parameters",
]
