"""One figure a study, in the paper's form: recall over a sweep, cumulative distributions, seconds over views."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.ticker import NullLocator  # noqa: E402

from .runner import grouped, mean  # noqa: E402


def lines_of(record, key):
    """series -> (labels, means over objects)"""
    out = {}
    for (series, label), rows in grouped(record["points"]):
        x, y = out.setdefault(series, ([], []))
        x.append(label), y.append(mean(rows, key))
    return out


def plain_numbers(axis, ticks):
    """Ticks of a logarithmic axis as they are said: 1, 2, 5, 10."""
    low, high = axis.get_view_interval()
    axis.set_ticks([t for t in ticks if low <= t <= high])
    axis.set_major_formatter("{x:g}")
    axis.set_minor_locator(NullLocator())


def decades(low, high):
    return [digit * 10.0 ** power for power in range(low, high) for digit in (1, 2, 5)]


def bars(axes, record):
    """A bar a series beside each other, where the labels are words and no line leads from one to the next."""
    lines = lines_of(record, "recall_10")
    labels = list(dict.fromkeys(label for x, _ in lines.values() for label in x))
    width = 0.8 / len(lines)
    for k, (series, (x, y)) in enumerate(lines.items()):
        at = [labels.index(label) + (k - (len(lines) - 1) / 2) * width for label in x]
        drawn = axes.bar(at, y, width, label=series)
        axes.bar_label(drawn, fmt="%.2f", fontsize=7)
    axes.set_xticks(range(len(labels)), labels)
    axes.set(ylabel="registration recall (10°)", ylim=(0, 1.08))
    axes.legend()


def sweep(axes, study, record):
    if any(isinstance(p["label"], str) for p in record["points"]):
        return bars(axes, record)
    for series, (x, y) in lines_of(record, "recall_10").items():
        axes.plot(x, y, "o-", label=f"{series} 10°".strip())
    if len(lines_of(record, "recall_10")) == 1:
        for _, (x, y) in lines_of(record, "recall_5").items():
            axes.plot(x, y, "s--", label="5°")
    axes.set(xlabel=study.axis, ylabel="registration recall", ylim=(-0.02, 1.04))
    axes.legend()


def cdf(axes, study, record):
    degrees = np.arange(1, 181)
    for (series, label), rows in grouped(record["points"]):
        axes.plot(degrees, np.mean([r["cdf"] for r in rows], axis=0), label=f"{series} {label}".strip())
    axes.set(xscale="log", xlim=(1, 180), xlabel="relative rotation error (deg)", ylabel="share of pairs",
             ylim=(-0.02, 1.04))
    plain_numbers(axes.xaxis, [*decades(0, 3), 180])
    axes.legend()


def seconds(axes, study, record):
    for _, (x, y) in lines_of(record, "wall_s").items():
        axes.loglog(x, y, "o-", label="wall")
    for _, (x, y) in lines_of(record, "cpu_s").items():
        axes.loglog(x, y, "s--", label="processor")
    axes.set(xlabel=study.axis, ylabel="seconds")
    plain_numbers(axes.xaxis, sorted({p["label"] for p in record["points"]}))
    plain_numbers(axes.yaxis, decades(-1, 5))
    axes.legend()


FIGURES = {"sweep": sweep, "cdf": cdf, "time": seconds}


def draw(study, record, folder):
    if study.kind not in FIGURES:
        return
    folder.mkdir(parents=True, exist_ok=True)
    figure, axes = plt.subplots(figsize=(5, 3.4), constrained_layout=True)
    FIGURES[study.kind](axes, study, record)
    axes.set_title(f"{study.title} ({record['level']})", fontsize=10)
    axes.grid(alpha=0.3)
    # No date or library version in the file: the same numbers give the same bytes.
    figure.savefig(folder / f"{study.name}.png", dpi=110, metadata={"Software": None})
    plt.close(figure)
