"""docs/benchmarks.md: every study owns the lines between its two markers, everything else is left alone."""
import re

import numpy as np

from .runner import grouped, mean


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]


def place(series, label):
    return f"{series}, {label}" if series else str(label)


def degrees(group):
    value = mean(group, "median_deg")
    return "-" if np.isnan(value) else f"{value:.2f}"


def peak(group):
    values = [g["peak_mib"] for g in group if g["peak_mib"] is not None]
    return f"{max(values):.0f}" if values else "-"


def sweep_table(study, record):
    objects = record["objects"]
    rows = []
    for (series, label), group in grouped(record["points"]):
        each = [f"{g['recall_10']:.3f}" for g in group] if len(objects) > 1 else []
        rows.append([place(series, label), f"{mean(group, 'recall_5'):.3f}", f"{mean(group, 'recall_10'):.3f}", *each,
                     degrees(group), f"{mean(group, 'wall_s'):.1f}", f"{mean(group, 'cpu_s'):.1f}",
                     peak(group)])
    return table([study.axis, "recall 5 deg", "recall 10 deg", *(objects if len(objects) > 1 else []), "median deg",
                  "s", "CPU s", "peak MiB"], rows)


def angle_table(study, record):
    rows = []
    for (series, label), group in grouped(record["points"]):
        cells = []
        for b in range(4):
            bins = [g["bins"][b] for g in group if g["bins"] and g["bins"][b]["pairs"]]
            pairs = sum(x["pairs"] for x in bins)
            cells.append(f"{100 * sum(x['recall'] * x['pairs'] for x in bins) / pairs:.2f} ({pairs})" if pairs else "-")
        rows.append([place(series, label), *cells])
    return table([study.axis, "up to 45 deg", "45 to 90", "90 to 135", "135 to 180"], rows)


def peers_table(study, record):
    rows = []
    for g in record["points"]:
        where = [place(g["series"], g["label"]), g["object"], g["method"]]
        if g.get("skipped"):
            rows.append([*where, *6 * "-", g["skipped"]])
        else:
            rows.append([*where, f"{g['recall_5']:.3f}", f"{g['recall_10']:.3f}", f"{g['median_deg']:.2f}",
                         f"{g['wall_s']:.1f}", f"{g['cpu_s']:.1f}", peak([g]), g.get("note", "")])
    return table([study.axis, "object", "method", "recall 5 deg", "recall 10 deg", "median deg", "s", "CPU s", "peak MiB",
                  "note"], rows)


def period(half_maps):
    value = half_maps and half_maps["resolution_nm"]
    return "none" if value is None else f"{value:.2f}"


def resolution_table(study, record):
    rows = []
    for (series, label), group in grouped(record["points"]):
        r = group[0].get("resolution") or {}
        rows.append([place(series, label), period(r.get("halves")), period(r.get("noise")),
                     f"{mean(group, 'recall_10'):.3f}", degrees(group),
                     f"{group[0]['accepted']} of {group[0]['particles']}", f"{mean(group, 'wall_s'):.1f}",
                     f"{mean(group, 'cpu_s'):.1f}"])
    return table([study.axis, "resolution nm", "of pure noise nm", "recall 10 deg", "median deg", "accepted",
                  "s", "CPU s"], rows)


TABLES = {"sweep": sweep_table, "cdf": sweep_table, "time": sweep_table, "initial_angle": angle_table,
          "peers": peers_table, "resolution": resolution_table}


def section(study, record, figures, report):
    lines = [f"## {study.title}", "", study.text, "", f"Paper: {study.paper}.", ""]
    if record["skipped"]:
        return lines + [f"Not run with this build: {record['skipped']}", ""]
    loads = [p["load"] for p in record["points"] if "load" in p]
    busy = f", load average {min(loads):.1f} to {max(loads):.1f} at the start of the runs" if loads else ""
    objects = f" Objects: {', '.join(record['objects'])}." if record["objects"] else ""
    lines += [f"Level `{record['level']}`: {record['views']} views unless the table says otherwise.{objects} "
              f"{record['version']}, {record['machine']}{busy}, {record['date']}.", ""]
    lines += TABLES[study.kind](study, record)
    if study.kind == "time" and len(record["points"]) > 1:
        points = record["points"]
        slope = exponent([p["particles"] for p in points], [p["cpu_s"] for p in points])
        lines += ["", f"CPU seconds grow with the number of views to the power {slope:.2f}."]
    figure = figures / f"{study.name}.png"
    if figure.is_file():
        lines += ["", f"![{study.title}]({figure.relative_to(report.parent)})"]
    return lines + [""]


def write(study, record, report, figures):
    begin, end = f"<!-- begin study {study.name} -->", f"<!-- end study {study.name} -->"
    block = "\n".join([begin, *section(study, record, figures, report), end])
    text = report.read_text() if report.is_file() else ""
    if begin in text:
        text = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: block, text, flags=re.S)
    else:
        text = text.rstrip("\n") + "\n\n" + block + "\n"
    report.write_text(text)


def exponent(views, seconds):
    """Slope of log seconds over log views: 1 is linear."""
    return float(np.polyfit(np.log(views), np.log(seconds), 1)[0])
