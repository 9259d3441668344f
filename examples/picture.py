"""Draws curves over time for the examples: panels in one SVG file, the same bytes for the same values."""

import io
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

POINTS = 300  # of a curve, more than a page shows
GREY, BLUE, ORANGE = "0.6", "C0", "C1"


def draw(path, title, time, panels):
    """Draws each panel, a pair of a label and a list of curves (label, values, colour), one below the other.

    A curve without a label is a limit, a constant.
    """
    plt.rcParams |= {"svg.hashsalt": "moris", "svg.fonttype": "none", "font.family": "sans-serif"}
    size = (9, max(2.8, 2.4 * len(panels)))
    figure, axes = plt.subplots(len(panels), 1, figsize=size, sharex=True, squeeze=False, layout="constrained")
    axes = axes[:, 0]
    figure.suptitle(title)
    shown = np.linspace(0, len(time) - 1, POINTS).astype(int)
    for axis, (quantity, curves) in zip(axes, panels):
        for label, values, colour in curves:
            if label is None:
                axis.axhline(values, color="black", linestyle="--", linewidth=1)
            else:
                axis.plot(np.asarray(time)[shown], np.round(np.asarray(values)[shown], 5), color=colour, label=label)
        axis.set_ylabel(quantity)
        axis.grid(alpha=0.3)
        axis.margins(y=0.15)
        axis.legend(loc="upper left", ncols=6, fontsize="small", frameon=False)
    axes[-1].set_xlabel("time [s]")
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    svg = io.StringIO()
    figure.savefig(svg, format="svg", metadata={"Date": None})
    plt.close(figure)
    # A hundredth of a point is finer than any screen.
    Path(path).write_text(re.sub(r"\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}", svg.getvalue()))
    print(f"wrote {path}")
