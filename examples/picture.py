"""Draws curves over time for the examples: panels in one SVG file, the same bytes for the same values."""

import io
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

BUCKETS = 300  # of a curve, each with its least and its largest value: no needle is lost
GREY, BLUE, ORANGE = "0.6", "C0", "C1"


def draw(path, title, time, panels):
    """Draws each panel, a pair of a label and a list of curves (label, values, colour), one below the other.

    A curve without a label is a limit, a constant. Beside a panel whose first curve is "desired" stands its roughest second.
    """
    plt.rcParams |= {"svg.hashsalt": "moris", "svg.fonttype": "none", "font.family": "sans-serif"}
    time = np.asarray(time)
    compared = [curves[0][0] == "desired" for _, curves in panels]
    columns = {"ncols": 2, "width_ratios": [4, 1]} if any(compared) else {}
    size = (9, max(2.8, 2.4 * len(panels)))
    figure, axes = plt.subplots(len(panels), figsize=size, squeeze=False, layout="constrained", **columns)
    figure.suptitle(title)
    for row, (quantity, curves), is_compared in zip(axes, panels, compared):
        draw_curves(row[0], time, curves, extremes)
        row[0].set_ylabel(quantity)
        row[0].legend(loc="upper left", ncols=6, fontsize="small", frameon=False)
        if is_compared:
            second = roughest_second(time, curves)
            row[0].axvspan(time[second][0], time[second][-1], color="0.93", zorder=0)
            draw_curves(row[1], time[second], [(label, np.asarray(values)[second], colour) for label, values, colour in curves], all_of)
            row[1].set_title("roughest second", fontsize="small")
        elif len(row) > 1:
            row[1].remove()
    axes[-1][0].set_xlabel("time [s]")
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    svg = io.StringIO()
    figure.savefig(svg, format="svg", metadata={"Date": None})
    plt.close(figure)
    # A hundredth of a point is finer than any screen.
    Path(path).write_text(re.sub(r"\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}", svg.getvalue()))
    print(f"wrote {path}")


def draw_curves(axis, time, curves, shown):
    for label, values, colour in curves:
        if label is None:
            axis.axhline(values, color="black", linestyle="--", linewidth=1)
        else:
            values = np.round(values, 5)
            drawn = shown(values)
            axis.plot(time[drawn], values[drawn], color=colour, label=label)
    axis.grid(alpha=0.3)
    axis.margins(y=0.15)


def all_of(values):
    return np.arange(len(values))


def extremes(values):
    """Places of the least and the largest value of each bucket, and of the ends."""
    edges = np.linspace(0, len(values), BUCKETS + 1).astype(int)
    buckets = [(a, b) for a, b in zip(edges, edges[1:]) if a < b]
    found = {a + place(values[a:b]) for a, b in buckets for place in (np.argmin, np.argmax)}
    return np.array(sorted(found | {0, len(values) - 1}))


def roughest_second(time, curves):
    """The second in which a felt curve has least of the desired curve's shape: the largest standard deviation of their difference."""
    desired = np.asarray(curves[0][1])
    count = int(round(1 / (time[1] - time[0]))) + 1
    begins = range(0, len(time) - count, max(1, count // 20))
    roughness = {
        begin: max(np.std((np.asarray(felt) - desired)[begin : begin + count]) for label, felt, _ in curves[1:] if label)
        for begin in begins
    }
    # Rounded, so that the last bits of another processor choose the same.
    begin = max(begins, key=lambda begin: round(roughness[begin], 4))
    return slice(begin, begin + count)
