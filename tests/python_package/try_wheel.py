"""Tries an installed wheel: steps, arrays, states, a sweep on threads, tuning and errors. Needs numpy only.

    python3 try_wheel.py

Prints a digest of all numbers, which is the same on every platform.
"""

import hashlib
import pickle
import sys

import moris
import numpy as np

STRATEGIES = ("classical", "adaptive", "optimal", "robust", "predictive")


def few_bits(values):
    """Values rounded to multiples of 2^-20: sines differ in the last bit from one numpy to another."""
    return np.round(values * 2.0**20) / 2.0**20


def samples(count=2001):
    """Times, specific force and angular velocity."""
    t = np.arange(count) * 0.01
    force = np.column_stack([np.sin(0.5 * t), 0.4 * np.sin(0.8 * t), 9.80665 + 0.1 * np.sin(2 * t)])
    rate = np.column_stack([0.05 * np.cos(0.6 * t), 0 * t, 0.1 * np.sin(0.3 * t)])
    return t, few_bits(force), few_bits(rate)


def numbers():
    """Results of every part of the package that needs no other package."""
    t, force, rate = samples()
    for strategy in STRATEGIES:
        washout = moris.Washout(strategy=strategy)
        first = washout.run(t[:1001], force[:1001], rate[:1001])
        again = pickle.loads(pickle.dumps(washout))
        assert again == washout
        output = washout.step(0.01, force[1000], rate[1000])
        assert dict(again.step(0.01, force[1000], rate[1000])) == dict(output)
        yield first.array
        yield [float(value) for value in output.values()]
    columns = {"time": t, **dict(zip(("ax", "ay", "az", "wx", "wy", "wz"), (*force.T, *rate.T)))}
    recording = moris.Recording(columns, name="ride", fade_in=1.0)
    yield moris.simulate(recording, parameters="preview", preview=1.0).array
    swept = moris.sweep(recording, [{"splitter.x.omega1": 1.0 + 0.125 * k} for k in range(8)])
    yield [result.values for result in swept.value]
    tuned = moris.tune(recording, strategy="classical", groups=["scale"], evaluations=30)
    yield [value for value in tuned.parameters.values() if isinstance(value, float)]


def main():
    digest = hashlib.sha256()
    for values in numbers():
        digest.update(np.ascontiguousarray(values, dtype="<f8").tobytes())
    try:
        moris.Washout(parameters={"spliter.x.omega1": 2.0})
    except moris.ParameterError as error:
        assert error.suggestions[0] == "splitter.x.omega1"
    else:
        sys.exit("a wrong name was accepted")
    print(f"Python {sys.version.split()[0]} on {sys.platform}, numpy {np.__version__}: {digest.hexdigest()[:16]}")


if __name__ == "__main__":
    main()
