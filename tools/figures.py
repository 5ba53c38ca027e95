# SPDX-License-Identifier: Apache-2.0
"""The figures of Mendez, Sbert, Neumann, "Obscurances for ray-tracing" (2003), made with obscura: the falloffs
rho (figure 1), the kitchen without one feature at a time and with all (figure 2), sqrt against exp (figure 3),
and the seconds of each render beside the paper's. Run by tools/figures, which builds the program first."""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]

# key, caption, options beyond the defaults, the paper's seconds (Pentium 4, 1.6 GHz) if it gives them.
RENDERS = [
    ("2a", "Without obscurances", ["--no-obscurance"], 260),
    ("2b", "Without direct light", ["--no-direct"], 396),
    ("2c", "Without mirroring surfaces", ["--no-specular"], 355),
    ("2d", "Every feature included", [], 527),
    ("3a", "Square root function", ["--rho", "sqrt"], None),
    ("3b", "Negative exponential function", ["--rho", "exp"], None),
]

# What the paper's seconds were taken with; at other settings only the shares of (d) compare.
PAPER_SETTINGS = {"width": 800, "height": 600, "spp": 8, "obscurance_rays": 5, "triangles": 28937, "objects": 203}

# rho(t) for t = d / d_max below 1; from there on every falloff is 1. Dashed: those that jump at t = 1.
FALLOFFS = [
    ("step", r"step: $0$", lambda t: np.zeros_like(t)),
    ("linear", r"linear: $t$", lambda t: t),
    ("sqrt", r"sqrt: $t^{1/2}$", np.sqrt),
    ("cbrt", r"cbrt: $t^{1/3}$", np.cbrt),
    ("exp", r"exp: $(1 - e^{-t}) / (1 - e^{-1})$", lambda t: np.expm1(-t) / np.expm1(-1.0)),
    ("expjump", r"expjump: $1 - e^{-t}$", lambda t: -np.expm1(-t)),
    ("pow:2", r"pow:2: $t^2$", lambda t: t**2),
]
JUMPING = {"step", "expjump"}


def parse_arguments():
    parser = argparse.ArgumentParser(prog="tools/figures", description=__doc__)
    parser.add_argument("--scene", default=str(ROOT / "scenes/kitchen"), help="scene file or folder (default: kitchen)")
    parser.add_argument("--width", type=int, default=800, help="pixels (default: the paper's 800)")
    parser.add_argument("--height", type=int, default=600, help="pixels (default: the paper's 600)")
    parser.add_argument("--spp", type=int, default=8, help="camera rays per pixel (default: the paper's 8)")
    parser.add_argument("--repeats", type=int, default=3, help="renders of each picture; the median counts (default: 3)")
    parser.add_argument("--device", help="OpenCL device, as for obscura render")
    parser.add_argument("--out", default=str(ROOT / "out"), help="folder for figures.png, .md, .json (default: out)")
    arguments = parser.parse_args()
    if arguments.repeats < 1:
        parser.error("--repeats must be at least 1")
    return arguments


def render(arguments, folder, key, options):
    """Renders one picture; returns its statistics. Warnings, the same for every picture, are not repeated here."""
    stats = folder / f"{key}.json"
    command = [str(ROOT / "build/obscura"), "render", arguments.scene, "--quiet"]
    command += ["-o", str(folder / f"{key}.exr"), "--preview", str(folder / f"{key}.png"), "--stats", str(stats)]
    command += ["--width", str(arguments.width), "--height", str(arguments.height), "--spp", str(arguments.spp)]
    if arguments.device:
        command += ["--device", arguments.device]
    result = subprocess.run(command + options, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{result.stderr}tools/figures: obscura ended with exit code {result.returncode}: "
                 f"{' '.join(command + options)}")
    return json.loads(stats.read_text(encoding="utf-8"))


def render_all(arguments, folder):
    """Every picture --repeats times, in turn, so that a slow minute of the machine touches all alike."""
    runs = {key: [] for key, *_ in RENDERS}
    for repeat in range(arguments.repeats):
        for key, caption, options, _ in RENDERS:
            print(f"render {repeat + 1} of {arguments.repeats}: {key} {caption}", flush=True)
            runs[key].append(render(arguments, folder, key, options))
    return runs


def make_rows(runs):
    """One dictionary per picture: what the table, the JSON and the captions show."""
    stats = runs["2d"][-1]
    same_work = all(stats[name] == value for name, value in PAPER_SETTINGS.items())
    rows = []
    for key, caption, options, paper_seconds in RENDERS:
        seconds = [run["seconds"]["render"] for run in runs[key]]
        rows.append({
            "figure": key,
            "caption": caption,
            "options": " ".join(options),
            "seconds": statistics.median(seconds),
            "seconds_of_each_run": seconds,
            "paper_seconds": paper_seconds,
            "rays": runs[key][-1]["rays"],
        })
    full = next(row for row in rows if row["figure"] == "2d")
    for row in rows:
        row["relative_to_2d"] = row["seconds"] / full["seconds"]
        if row["paper_seconds"] is not None:
            row["paper_relative_to_2d"] = row["paper_seconds"] / full["paper_seconds"]
        if row["paper_seconds"] is not None and same_work:
            row["times_faster_than_paper"] = row["paper_seconds"] / row["seconds"]
    return rows


def markdown_table(arguments, stats, rows):
    """The table of seconds, with the settings and the device that they were taken with."""
    def cell(row, name, form):
        return format(row[name], form) if row.get(name) is not None else ""

    repeats = "one run" if arguments.repeats == 1 else f"median of {arguments.repeats} runs"
    lines = [
        f"{stats['width']} x {stats['height']} pixels, {stats['spp']} rays per pixel, "
        f"{stats['obscurance_rays']} obscurance rays per hit; {stats['triangles']} triangles in "
        f"{stats['objects']} objects; device: {stats['device']}; render phase, {repeats}.",
        "",
        "| figure | picture | options | seconds | of (d) | paper, seconds | paper, of (d) | times faster |",
        "|---|---|---|---:|---:|---:|---:|---:|",
    ]
    for row in rows:
        options = f"`{row['options']}`" if row["options"] else ""
        lines.append(
            f"| {row['figure']} | {row['caption']} | {options} | {row['seconds']:.2f} | {row['relative_to_2d']:.2f} | "
            f"{cell(row, 'paper_seconds', 'd')} | {cell(row, 'paper_relative_to_2d', '.2f')} | "
            f"{cell(row, 'times_faster_than_paper', '.0f')} |")
    kinds = list(rows[0]["rays"])
    lines += ["", "| figure | " + " | ".join(f"{kind} rays" for kind in kinds) + " |", "|---|" + "---:|" * len(kinds)]
    lines += [f"| {row['figure']} | " + " | ".join(f"{row['rays'][kind]:,}" for kind in kinds) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def plot_falloffs(axes):
    open_end = np.linspace(0.0, 1.0, 500, endpoint=False)
    beyond = np.array([1.0, 1.25])
    for name, label, falloff in FALLOFFS:
        style = "--" if name in JUMPING else "-"
        t = np.concatenate([open_end, beyond])
        axes.plot(t, np.concatenate([falloff(open_end), np.ones(2)]), style, label=label)
    axes.set_xlabel(r"distance of the nearest surface, $t = d / d_{max}$")
    axes.set_ylabel(r"$\rho(t)$")
    axes.set_xlim(0, 1.25)
    axes.set_ylim(-0.02, 1.05)
    axes.grid(alpha=0.3)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.08), fontsize="small")
    axes.set_title(r"Figure 1. The falloffs $\rho$", loc="left")


def plot_seconds(axes, rows):
    """Share of the full picture's time, ours beside the paper's: what each feature costs on either machine."""
    timed = [row for row in rows if row["paper_seconds"] is not None]
    place = np.arange(len(timed))
    ours = axes.bar(place - 0.2, [row["relative_to_2d"] for row in timed], 0.4, label="obscura")
    paper = axes.bar(place + 0.2, [row["paper_relative_to_2d"] for row in timed], 0.4, label="paper", color="0.7")
    axes.bar_label(ours, [f"{row['seconds']:.2f} s" for row in timed])
    axes.bar_label(paper, [f"{row['paper_seconds']} s" for row in timed])
    axes.set_xticks(place, [textwrap.fill(f"({row['figure'][1]}) {row['caption']}", 18) for row in timed])
    axes.set_ylabel("seconds, relative to (d)")
    axes.set_ylim(0, 1.25 * max(max(row["relative_to_2d"], 1) for row in timed))
    axes.legend(loc="upper left")
    axes.set_title("Rendering time of figure 2", loc="left")


def draw_sheet(folder, rows, path):
    """Two columns: plots, figure 2 (a) to (d), figure 3 (a) and (b)."""
    pixels = {row["figure"]: matplotlib.image.imread(folder / f"{row['figure']}.png") for row in rows}
    height, width = pixels["2d"].shape[:2]
    column = 8.0  # inches; at 100 dpi the paper's 800 pixels are shown one to one
    row_height = column * height / width + 0.4
    figure, axes = plt.subplots(4, 2, figsize=(2 * column + 0.4, 4 * row_height), dpi=100,
                                layout="constrained")
    plot_falloffs(axes[0, 0])
    plot_seconds(axes[0, 1], rows)
    for place, row in zip(axes[1:].flat, rows):
        place.imshow(pixels[row["figure"]], interpolation="nearest")
        place.set_axis_off()
        place.set_title(f"Figure {row['figure'][0]} ({row['figure'][1]}). {row['caption']}: {row['seconds']:.2f} s", loc="left")
    figure.savefig(path)
    plt.close(figure)


def main():
    arguments = parse_arguments()
    out = pathlib.Path(arguments.out)
    folder = out / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    runs = render_all(arguments, folder)
    rows = make_rows(runs)
    stats = runs["2d"][-1]
    facts = {name: stats[name] for name in ("device", "width", "height", "spp", "obscurance_rays", "triangles", "objects")}
    (out / "figures.json").write_text(json.dumps({**facts, "renders": rows}, indent=2) + "\n", encoding="utf-8")
    table = markdown_table(arguments, stats, rows)
    (out / "figures.md").write_text(table, encoding="utf-8")
    draw_sheet(folder, rows, out / "figures.png")
    print("\n" + table)
    print(f"{out / 'figures.png'}  the contact sheet; {out / 'figures.md'}, .json: the table; {folder}: each picture")


if __name__ == "__main__":
    main()
