"""docs/results.md: every study owns the lines between its two markers, everything else is left alone."""
import re
import textwrap

import numpy as np

from .runner import grouped, mean


COLUMNS = 108  # of the document


def wrapped(text):
    """Paragraphs, each filled."""
    out = []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        out += [*textwrap.wrap(" ".join(paragraph.split()), COLUMNS, break_long_words=False, break_on_hyphens=False), ""]
    return out[:-1]


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


def lowest(group):
    worst = min(group, key=lambda g: g["recall_10"])
    return f"{worst['recall_10']:.3f} ({worst['object']})"


def sweep_table(study, record):
    several = len(record["objects"]) > 1
    rows = []
    for (series, label), group in grouped(record["points"]):
        rows.append([place(series, label), f"{mean(group, 'recall_5'):.3f}", f"{mean(group, 'recall_10'):.3f}",
                     *([lowest(group)] if several else []), degrees(group), f"{mean(group, 'wall_s'):.1f}",
                     f"{mean(group, 'cpu_s'):.1f}", peak(group)])
    return table([study.axis, "recall 5 deg", "10 deg", *(["lowest at 10 deg"] if several else []), "median deg",
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
    lines, notes = [], []
    for where in dict.fromkeys((place(g["series"], g["label"]), g["object"]) for g in record["points"]):
        rows = []
        for g in record["points"]:
            if (place(g["series"], g["label"]), g["object"]) != where:
                continue
            note = g.get("skipped") or g.get("note", "")
            if note:
                notes.append(f"{', '.join(filter(None, where))}: {g['method']}: {note}")
            rows.append([g["method"], *6 * "-"] if g.get("skipped") else
                        [g["method"], f"{g['recall_5']:.3f}", f"{g['recall_10']:.3f}", f"{g['median_deg']:.2f}",
                         f"{g['wall_s']:.1f}", f"{g['cpu_s']:.1f}", peak([g])])
        lines += [f"**{', '.join(filter(None, where))}**", "",
                  *table(["method", "recall 5 deg", "10 deg", "median deg", "s", "CPU s", "peak MiB"], rows), ""]
    for note in notes:
        lines += textwrap.wrap(f"- {note}", COLUMNS, subsequent_indent="  ", break_long_words=False)
    return lines


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
    lines = [f"## {study.title}", "", *wrapped(study.text), "", *wrapped(f"Paper: {study.paper}."), ""]
    if record["skipped"]:
        return lines + [*wrapped(f"Not run with this build: {record['skipped']}"), ""]
    loads = [p["load"] for p in record["points"] if "load" in p]
    busy = f", load average {min(loads):.1f} to {max(loads):.1f} at the start of the runs" if loads else ""
    objects = f" Objects: {', '.join(record['objects'])}." if record["objects"] else ""
    lines += [f"    scripts/bench --level {record['level']} --study {study.name}", "",
              *wrapped(f"{record['views']} views unless the table says otherwise.{objects} {record['version']}, "
                       f"{record['machine']}{busy}, {record['date']}."), ""]
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
