"""FMPy: validation, and every option of its simulation that concerns co-simulation."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import report
import simulator
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssv
from fmpy.util import read_csv
from fmpy.validation import validate_fmu
from ride import Ride

FMUS, WORK = sys.argv[1].split(","), Path(sys.argv[2])
# Every option is tried with the first one, the others by the plain ride.
FMU, *OTHERS = FMUS
RIDE = Ride(FMU)
# FMPy has room for the derivatives of nine inputs, no more and no fewer.
NINE = 9


def answers(result, names=RIDE.outputs):
    """The outputs at each communication point."""
    rows = np.column_stack([result[name] for name in names])
    return {round(time / RIDE.step): row.tolist() for time, row in zip(result["time"], rows)}


def simulate(signals, **options):
    options = {"stop_time": RIDE.stop, "output_interval": RIDE.step, "output": RIDE.outputs, **options}
    return simulate_fmu(FMU, input=signals, **options)


def ride_with(what, signals, **options):
    report.difference(what, RIDE.difference(answers(simulate(signals, **options))))


def options(signals):
    report.ride(RIDE, "", RIDE.difference(answers(simulate(signals))))
    ride_with("ride, not validated, no stop time told", signals, validate=False, set_stop_time=False)
    ride_with("ride, with a tolerance, all start values applied", signals, relative_tolerance=1e-6, apply_default_start_values=True)
    calls, messages = [], []
    logger = lambda environment, instance, status, category, message: messages.append(message)
    ride_with("ride, calls and messages logged, visible", signals, debug_logging=True, visible=True, logger=logger, fmi_call_logger=calls.append)
    report.check("every call of it returned fmi2OK", not problems_in(calls), "; ".join(problems_in(calls)[:3]))


def problems_in(calls):
    return [call for call in calls if any(bad in call for bad in ("fmi2Warning", "fmi2Discard", "fmi2Error", "fmi2Fatal"))]


def without_input():
    result = simulate(None)
    moved = max(np.ptp(result[name]) for name in result.dtype.names[1:] if name != "predictive.planAge")
    report.difference("ten seconds without input: nothing moves", moved)


def stopped_early(signals):
    half = RIDE.steps // 2
    result = simulate(signals, step_finished=lambda time, recorder: time < RIDE.time(half) - 0.5 * RIDE.step)
    ended = abs(result["time"][-1] - RIDE.time(half)) < 1e-9
    report.check("ride, stopped half way by step_finished", ended, f"ended at {result['time'][-1]} s")
    report.difference("and until then", RIDE.difference(answers(result), last=half))


def start_values():
    # A tunable and a fixed real, an integer, an enumeration, a Boolean.
    wanted = {"tilt.angleLimit": 0.125, "head.height": 1.0, "splitter.order": 3, "compensation": 2, "engaged": False}
    # The FMU warns that it is not engaged. FMPy 0.3.32 keeps the logger of an earlier simulation, which is gone, unless it gets one.
    warnings = []
    result = simulate(None, start_values=wanted, output=list(wanted), logger=lambda *arguments: warnings.append(arguments[-1]))
    report.check("a warning of it arrives", len(warnings) == 1 and b"engaged is false" in warnings[0], f"{warnings}")
    got = {name: result[name][-1] for name in wanted}
    report.check("start values of every type", got == wanted, f"got {got}")


def in_two_halves(signals):
    """Half a ride, its state as bytes, and the rest of it by another instance that begins with the state."""
    description = read_model_description(FMU)
    directory = extract(FMU)
    half = RIDE.time(RIDE.steps // 2)
    instance = instantiate_fmu(directory, description, "CoSimulation")
    first = simulate(signals, fmu_instance=instance, model_description=description, stop_time=half, set_stop_time=False, terminate=False)
    state = instance.getFMUState()
    data = instance.serializeFMUState(state)
    instance.freeFMUState(state)
    instance.terminate()
    instance.freeInstance()
    second = simulate(signals, start_time=half, set_stop_time=False, fmu_state=data, initialize=False)
    report.difference("ride in two halves, joined by a serialized state", RIDE.difference({**answers(first), **answers(second)}))
    shutil.rmtree(directory, ignore_errors=True)


def derivatives(signals):
    """FMPy's option set_input_derivatives, against a loop that gives the same slopes."""
    names = signals.dtype.names[1 : NINE + 1]
    nine = signals[["time", *names]].copy()
    result = simulate(nine, set_input_derivatives=True)

    description = read_model_description(FMU)
    directory = extract(FMU)
    slave = FMU2Slave(guid=description.guid, unzipDirectory=directory, modelIdentifier=RIDE.model, instanceName="ride")
    slave.instantiate()
    slave.setupExperiment()
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    inputs, outputs = ([RIDE.references[name] for name in list] for list in (names, RIDE.outputs))
    rows = []
    for k in range(RIDE.steps):
        time = RIDE.time(k)
        # At a breakpoint FMPy gives the slope that was, and at the start none.
        after = int(np.clip(np.searchsorted(nine["time"], time), 1, len(nine) - 1))
        length = nine["time"][after] - nine["time"][after - 1]
        slopes = [(nine[name][after] - nine[name][after - 1]) / length if k else 0.0 for name in names]
        slave.setReal(inputs, RIDE.input(k)[:NINE])
        slave.setRealInputDerivatives(inputs, [1] * NINE, slopes)
        slave.doStep(time, RIDE.step)
        rows.append(slave.getReal(outputs))
    slave.terminate()
    slave.freeInstance()
    shutil.rmtree(directory, ignore_errors=True)
    simulated = np.column_stack([result[name] for name in RIDE.outputs])[1:]
    report.difference("ride with the slopes of nine inputs", float(np.abs(simulated - np.array(rows)).max()))
    held = np.column_stack([simulate(nine)[name] for name in RIDE.outputs])[1:]
    report.check("which make a difference", bool(np.abs(simulated - held).max() > 1e-4))


def command_line(input_file):
    result = WORK / "fmpy_out.csv"
    command = [sys.executable, "-m", "fmpy", "simulate", FMU, "--input-file", input_file, "--output-file", result]
    command += ["--stop-time", str(RIDE.stop), "--output-interval", str(RIDE.step)]
    command += ["--output-variables", *RIDE.outputs]
    subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL)
    report.difference("ride by the command `fmpy simulate`", RIDE.difference_of_table(result.read_text()))


def others():
    """The other FMUs: validation and the plain ride."""
    for fmu in OTHERS:
        ride = Ride(fmu)
        problems = validate_fmu(fmu)
        report.check(f"{ride.model}, FMI {ride.fmi}: validation", not problems, "; ".join(problems[:3]), ride.fmi)
        input_file = WORK / "other_in.csv"
        input_file.write_text(ride.input_text)
        result = simulate_fmu(
            fmu, input=read_csv(str(input_file)), stop_time=ride.stop, output_interval=ride.step, output=ride.outputs
        )
        rows = np.column_stack([result[name] for name in ride.outputs])
        answers = {round(time / ride.step): row.tolist() for time, row in zip(result["time"], rows)}
        report.ride(ride, "", ride.difference(answers))


def whole_simulator():
    """A few seconds of the whole simulator, by the system's own input and outputs."""
    package = Path(FMU).with_name("MotorcycleSimulator.ssp")
    if not package.exists():
        return
    parameters = read_ssv(package, f"resources/{simulator.PARAMETER_SET}.ssv")
    opened = simulator.STEP * simulator.OPENED_AT
    throttle = {"throttle": lambda time: simulator.THROTTLE if time >= opened else 0.0}
    result = simulate_ssp(
        package, stop_time=simulator.STEP * simulator.STEPS, step_size=simulator.STEP, parameter_set=parameters, input=throttle
    )[-1]
    lengths = [result[f"actuatorLength{i}"] for i in range(1, 7)]
    simulator.judge(result["speed"], lengths, simulator.VALUE, "the whole simulator, MotorcycleSimulator.ssp")


def lap():
    """A few seconds of the lap, which has no inputs and no parameter set."""
    package = Path(FMU).with_name("MotorcycleLap.ssp")
    if not package.exists():
        return
    result = simulate_ssp(package, stop_time=simulator.STEP * simulator.STEPS, step_size=simulator.STEP)[-1]

    def value(component, variable):
        return result[f"{component}.{variable}"]

    simulator.judge_lap(value, value, "the lap, MotorcycleLap.ssp")


def main():
    # First: FMPy 0.3.32 keeps the logger of an earlier simulation, which is gone, and the FMU warns of forces of zero.
    whole_simulator()
    lap()
    problems = validate_fmu(FMU)
    report.check("validation", not problems, "; ".join(problems[:3]))
    input_file = WORK / "in.csv"
    input_file.write_text(RIDE.input_text)
    signals = read_csv(str(input_file))
    options(signals)
    without_input()
    stopped_early(signals)
    start_values()
    in_two_halves(signals)
    derivatives(signals)
    command_line(input_file)
    others()


if __name__ == "__main__":
    main()
