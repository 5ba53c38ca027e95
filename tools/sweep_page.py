# SPDX-License-Identifier: Apache-2.0
"""One self-contained page of what `obscura sweep` measured: plots as inline SVG, crops as inline PNG, tables."""

import base64
import csv
import html
import io
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np

import price_needs
import sweep_flip

plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "obscura", "font.size": 9, "axes.grid": True,
                     "axes.grid.which": "both", "grid.alpha": 0.25, "legend.fontsize": 8})

SAMPLERS = ["lattice", "owen", "random", "k10", "k2", "k1"]
MODELS = ["none", "constant", "ao", "colourless", "obscurance", "path"]
COLORS = dict(zip(SAMPLERS + MODELS, plt.get_cmap("tab20").colors[::2][:6] + plt.get_cmap("Dark2").colors[:5] + ("black",)))
CROPPED = ["none", "constant", "ao", "obscurance", "path", "random", "lattice"]
BUILDS = ["needs-all", "portable"]
PAPER_BUDGET = 40  # 8 samples with 5 obscurance rays

STYLE = """body{font:15px/1.45 system-ui,sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222;background:#fff}
table{border-collapse:collapse;margin:1em 0;font-size:13px}td,th{padding:2px 9px;text-align:right;border-bottom:1px solid #ddd}
td:first-child,th:first-child{text-align:left}figure{display:inline-block;margin:4px;font-size:12px;vertical-align:top}
figure img{display:block;width:240px;image-rendering:pixelated}svg{max-width:100%;height:auto}summary{cursor:pointer}"""


def layer_of(row, layer):
    """The figures of a layer, or nothing if the method wasn't measured on it."""
    return row if layer == "beauty" else row.get("layers", {}).get(layer)


def number(value, form="{:.4g}"):
    return "–" if value is None else form.format(value)


def interval(figures, name, form="{:.4g}"):
    value, low, high = (figures.get(key) for key in (name, f"{name}_low", f"{name}_high"))
    return number(value, form) if low is None else f"{number(value, form)} ({number(low, form)} to {number(high, form)})"


def table(head, rows):
    lines = ["<table><tr>" + "".join(f"<th>{html.escape(str(cell))}</th>" for cell in head) + "</tr>"]
    lines += ["<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows]
    return "\n".join([*lines, "</table>"])


# --- Plots ---------------------------------------------------------------------------------------------------------


def relative(figures):
    """Relative RMSE with its interval; noise may make the estimate of a square negative."""
    return [None if square is None else max(square, 0) ** 0.5 for square in (figures[f"relmse{end}"] for end in ("", "_low", "_high"))]


def absolute(figures):
    return [figures[f"rmse{end}"] for end in ("", "_low", "_high")]


def plot_method(axes, sweep, name, layer, abscissa, error):
    """The error with its interval; the exponent of a fit stands in the legend where the error is a sampler's RMSE."""
    points = [(row[abscissa], layer_of(row, layer)) for row in sweep["methods"][name]]
    points = [(x, *error(figures)) for x, figures in points if figures and error(figures)[0]]
    if not points:
        return
    x, y = [point[0] for point in points], [point[1] for point in points]
    low = [max(0, value - (least or value)) for _, value, least, _ in points]
    high = [max(0, (most or value) - value) for _, value, _, most in points]
    fit = sweep["convergence"][name].get(layer, {}).get(abscissa)
    label = f"{name}, slope {fit['exponent']:.2f}" if error is absolute and fit else name
    axes.errorbar(x, y, yerr=[low, high], label=label, color=COLORS[name], marker="o", markersize=3, linewidth=1.2, capsize=2)


def plot_curves(sweep, names, layer, title, error=absolute):
    """Error against rays and against time, side by side."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True, layout="constrained")
    for place, abscissa, label in zip(axes, ("rays", "seconds"), ("rays of a picture", "seconds of rendering")):
        for name in names:
            if name in sweep["methods"]:
                plot_method(place, sweep, name, layer, abscissa, error)
        place.set(xscale="log", yscale="log", xlabel=label)
        place.legend()
    axes[0].set_ylabel(f"{'relative ' if error is relative else ''}RMSE of {layer}")
    figure.suptitle(title, x=0.01, ha="left")
    return figure


def draw_floors(axes, sweep):
    for name, found in sweep.get("overtaking", {}).items():
        if name in MODELS and found["floor"]:
            axes.axhline(found["floor"], color=COLORS[name], linestyle=":", linewidth=1)


def plot_models(sweep):
    figure = plot_curves(sweep, MODELS, "diffuse", "Models against path-traced light; dotted: what is left with any number of samples",
                         relative)
    for place in figure.axes:
        draw_floors(place, sweep)
    return figure


def plot_floors(sweep):
    """The error that each model keeps, all of them as bars."""
    found = {name: figures for name, figures in sweep.get("overtaking", {}).items() if figures["floor"] is not None}
    figure, axes = plt.subplots(figsize=(8, 0.3 * len(found) + 0.9), layout="constrained")
    for place, (name, figures) in enumerate(found.items()):
        axes.barh(place, figures["floor"], color="#7799bb")
        if figures["floor_low"] is not None:
            axes.plot([figures["floor_low"], figures["floor_high"]], [place, place], color="black", linewidth=1)
    axes.set_yticks(range(len(found)), list(found))
    axes.invert_yaxis()
    axes.set_xlabel("relative RMSE of diffuse light against path tracing that is left with any number of samples, and its 95 % interval")
    return figure


def svg(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    return text.getvalue()[text.getvalue().index("<svg"):]


def plot_flip(sweep, flip):
    """What a person sees of the error, against time: samplers beside their model, models beside path tracing."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True, layout="constrained")
    for place, names, reference in zip(axes, (SAMPLERS, MODELS), ("their own model", "path-traced light")):
        for name in names:
            points = [(row["seconds"], flip[name][row["budget"]]) for row in sweep["methods"].get(name, []) if row["budget"] in flip[name]]
            if points:
                place.plot(*zip(*points), label=name, color=COLORS[name], marker="o", markersize=3, linewidth=1.2)
        place.set(xscale="log", yscale="log", xlabel="seconds of rendering", title=f"beside {reference}")
        if place.lines:
            place.legend()
    axes[0].set_ylabel("mean FLIP")
    return figure


# --- Crops of equal time -------------------------------------------------------------------------------------------


def crop_png(path, window):
    pixels = matplotlib.image.imread(path)
    height, width = pixels.shape[:2]
    x0, x1, y0, y1 = window
    part = pixels[round(y0 * height):max(round(y1 * height), 1), round(x0 * width):max(round(x1 * width), 1)]
    data = io.BytesIO()
    matplotlib.image.imsave(data, np.ascontiguousarray(part), format="png")
    return "data:image/png;base64," + base64.b64encode(data.getvalue()).decode()


def equal_time_rows(sweep):
    """The seconds of the paper's settings, and of each method the picture that takes about as long."""
    rows = next((sweep["methods"][name] for name in ("obscurance", "lattice") if name in sweep["methods"]),
                next(iter(sweep["methods"].values())))
    seconds = min(rows, key=lambda row: abs(row["budget"] - PAPER_BUDGET))["seconds"]
    return seconds, {name: min(sweep["methods"][name], key=lambda row: abs(np.log(row["seconds"] / seconds)))
                     for name in CROPPED if name in sweep["methods"]}


def crops(folder, sweep, window):
    seconds, rows = equal_time_rows(sweep)
    figures = []
    for name, row in rows.items():
        caption = f"{name}, {row['samples_per_pixel']} spp, {row['seconds']:.3g} s, error {number(relative(layer_of(row, 'diffuse'))[0], '{:.3g}')}"
        figures.append((folder / "pictures" / f"{name}-{row['budget']}.png", caption))
    figures += [(folder / "pictures" / f"reference-{name}.png", f"reference: {name}") for name in sweep["references"]]
    shown = "".join(f'<figure><img src="{crop_png(path, window)}" alt=""><figcaption>{html.escape(caption)}</figcaption></figure>'
                    for path, caption in figures if path.exists())
    return f"<p>Of each method the picture whose time is nearest to {seconds:.3g} s; error: relative RMSE of diffuse light.</p>{shown}"


# --- Tables --------------------------------------------------------------------------------------------------------


def variance_table(sweep):
    ratios = sweep.get("variance_ratio_to_random", {})
    budgets = sorted({row["budget"] for rows in ratios.values() for row in rows})
    layers = ["obscurance", "diffuse", "beauty"]
    cells = {(name, row["layer"], row["budget"]): row["ratio"] for name, rows in ratios.items() for row in rows}
    return table(["method, layer", *(f"{budget} rays per pixel" for budget in budgets)],
                 [[f"{name}, {layer}", *(number(cells.get((name, layer, budget)), "{:.2f}") for budget in budgets)]
                  for name in ratios for layer in layers])


def overtaking_table(sweep):
    return table(["model", "meaning", "relative RMSE left", "path tracing is better from", "and from"],
                 [[name, sweep["meaning"][name], interval(found, "floor"),
                   number(found["path_better_after_seconds"], "{:.3g} s"), number(found["path_better_after_rays"], "{:.3g} rays")]
                  for name, found in sweep.get("overtaking", {}).items()])


def builds_table(sweep):
    """The same pictures from kernels that were compiled otherwise: seconds over those of the kernels that a render has."""
    own = {row["budget"]: row for row in sweep["methods"].get("lattice", [])}
    builds = [(name, row, own[row["budget"]]) for name in BUILDS for row in sweep["methods"].get(name, []) if row["budget"] in own]
    return table(["kernels", "budget", "seconds", "of a render's own", "ratio", "RMSE over theirs"],
                 [[name, row["budget"], number(row["seconds"]), number(render["seconds"]),
                   number(row["seconds"] / render["seconds"], "{:.2f}"), number(row["rmse"] / render["rmse"], "{:.6f}")]
                  for name, row, render in builds])


def feature_tables(folder):
    """What tools/report needs wrote into the sweep's folder."""
    path = folder / "needs.json"
    if not path.exists():
        return ""
    prices = json.loads(path.read_text(encoding="utf-8"))
    parts = [f"<details><summary>{html.escape(title)}</summary><p>{html.escape(note)}</p>{table(head, rows)}</details>"
             for title, note, head, rows in price_needs.tables(prices)]
    return "\n".join([f"<h2>What features cost</h2><p>{html.escape(price_needs.description(prices))}</p>", *parts])


def remedy_table(folder):
    """What tools/price-remedies wrote into the sweep's folder."""
    path = folder / "remedies.csv"
    if not path.exists():
        return ""
    with open(path, encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    return ("<h2>What remedies against rounding cost</h2><p>The kernels beside kernels that lack one remedy, by "
            f"<code>tools/price-remedies</code>.</p>{table(head, rows)}")


def flip_table(sweep, flip):
    budgets = sorted({budget for found in flip.values() for budget in found})
    return table(["method", "beside the reference", *(f"{budget} rays per pixel" for budget in budgets)],
                 [[name, sweep["measured_against"][name], *(number(found.get(budget), "{:.4f}") for budget in budgets)]
                  for name, found in flip.items()])


def perceived(folder, sweep):
    flip = sweep_flip.measure(folder, sweep)
    if flip is None:
        return (f"<p>Not measured: the Python package flip_evaluator is not installed (<code>{sweep_flip.HOW_TO_INSTALL}</code>).</p>")
    return (f"<p>FLIP (Andersson et al. 2020) of the 8-bit pictures of the first seed, {sweep_flip.PIXELS_PER_DEGREE} pixels per degree "
            f"of the visual field; 0: a person sees no difference.</p>{svg(plot_flip(sweep, flip))}"
            f"<details><summary>All of them</summary>{flip_table(sweep, flip)}</details>")


def method_tables(sweep):
    head = ["budget", "spp", "seconds (smallest to largest)", "rays", "RMSE", "relMSE", "MAPE", "bias ± standard error",
            "RMS bias", "1/(MSE s)", "reference's share"]
    parts = []
    for name, rows in sweep["methods"].items():
        for layer in ("beauty", "diffuse", "obscurance"):
            lines = []
            for row in rows:
                found = layer_of(row, layer)
                if found is None:
                    continue
                lines.append([row["budget"], row["samples_per_pixel"],
                              f"{row['seconds']:.4g} ({row['seconds_min']:.4g} to {row['seconds_max']:.4g})", f"{row['rays']:.4g}",
                              interval(found, "rmse"), number(found["relmse"]), number(found["mape"]),
                              f"{number(found['bias'], '{:.2g}')} ± {number(found['bias_standard_error'], '{:.2g}')}",
                              interval(found, "rms_bias", "{:.3g}"), number(found["efficiency"]),
                              number(found["reference_share"], "{:.1%}")])
            if lines:
                parts.append(f"<details><summary>{html.escape(name)}, {layer}: {html.escape(sweep['meaning'][name])}</summary>"
                             f"{table(head, lines)}</details>")
    return "\n".join(parts)


def machine_table(sweep):
    facts = [(name.replace("_", " "), value) for name, value in sweep.items()
             if value is not None and not isinstance(value, (dict, list))]
    for name, reference in sweep["references"].items():
        errors = ", ".join(f"{layer} {error:.2g}" for layer, error in reference["standard_error"].items())
        facts.append((f"reference {name}", f"{reference['samples_per_pixel']} spp in {reference['independent_sets']} sets, "
                      f"{reference['seconds']:.0f} s, {reference['tracer']}; standard error: {errors}"))
    return table(["", ""], facts)


def page(folder, sweep, window):
    """The page, and the plot that tells most: samplers on the obscurance layer above, models below."""
    unfinished = "" if sweep["complete"] else "<p><b>The sweep was stopped early: this is what there is.</b></p>"
    samplers = plot_curves(sweep, SAMPLERS, "obscurance", "Samplers (5 rays per sample) and splits (k rays per sample, lattice)")
    diffuse = plot_curves(sweep, SAMPLERS, "diffuse", "The same, of all diffuse light")
    parts = [
        f"<h1>Speed against error: {html.escape(sweep['scene'])}</h1>", unfinished,
        f"<p>{sweep['width']} × {sweep['height']} pixels, {sweep['seeds']} seeds; medians of interleaved repeats for times, "
        "bars are 95 % intervals. RMSE is what is left when the reference's own variance is subtracted. <i>Diffuse</i> is the "
        "picture without lights and sky, seen as they are or mirrored: their edges would drown everything else. Models are compared by relative RMSE, the root of relMSE, so that the few "
        "pixels beside a lamp don't decide. A <i>budget</i> "
        "counts obscurance rays per pixel.</p>",
        "<h2>Samplers</h2>", svg(samplers), svg(diffuse),
        "<p>Variance of random points over that of the method, with the same number of rays:</p>", variance_table(sweep),
        "<h2>Models</h2>", svg(plot_models(sweep)), overtaking_table(sweep), svg(plot_floors(sweep)),
        "<p>Path tracing here is that of <code>obscura reference</code>: double precision, on the host. Seconds compare the two "
        "programs, rays the methods. Crossings beyond the measured budgets follow power laws.</p>",
        "<h2>Equal time</h2>", crops(folder, sweep, window),
        "<h2>Perceived difference</h2>", perceived(folder, sweep),
        "<h2>Kernels compiled otherwise</h2>", builds_table(sweep), feature_tables(folder), remedy_table(folder), "<h2>All figures</h2>", method_tables(sweep),
        "<h2>Machine and settings</h2>", machine_table(sweep)]
    body = "\n".join(part for part in parts if part)
    return (f"<!DOCTYPE html><html lang=en><meta charset=utf-8><title>obscura sweep: {html.escape(sweep['scene'])}</title>"
            f"<style>{STYLE}</style><body>{body}</body></html>\n")


def main_plot(sweep, path):
    """Two plots for people in a hurry: obscurance against rays by sampler, diffuse light against time by model."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
    for place, names, layer, abscissa, error, label, title in (
            (axes[0], SAMPLERS, "obscurance", "rays", absolute, "rays of a picture", "Noise of the obscurances, by sample points"),
            (axes[1], MODELS, "diffuse", "seconds", relative, "seconds of rendering", "Error of diffuse light, by model; dotted: its floor")):
        for name in names:
            if name in sweep["methods"]:
                plot_method(place, sweep, name, layer, abscissa, error)
        place.set(xscale="log", yscale="log", xlabel=label, ylabel=f"{'relative ' if error is relative else ''}RMSE of {layer}")
        place.set_title(title, loc="left")
        place.legend()
    draw_floors(axes[1], sweep)
    figure.savefig(path, dpi=100, metadata={"Software": None})
    plt.close(figure)
