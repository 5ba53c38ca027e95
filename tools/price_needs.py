# SPDX-License-Identifier: Apache-2.0
"""What modelling a feature costs: kernels from which one NEED flag is taken are compiled and timed beside those that have it.
Of a flag that the scene needs that leaves its work out, and the picture is wrong; any other is taken from kernels with every
feature, and the picture stays. (Adding one alone would need queues that the host doesn't make.) Renders take turns, whichever
comes second is no slower for it, and medians of the pairs' ratios count."""

import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

# The small untextured scenes, and one that needs most features.
SMALL = ["cornell", "sphere", "planes"]
LARGE = "kitchen"
PICTURE = ["--width", "400", "--height", "300", "--spp", "2"]
STAGES = ["shade", "obscurance"]  # those that hold the features
# Ambient occlusion asks whether there is any hit; everything else how far the nearest is, and of which colour.
OBSCURANCES = {"step, no bleeding": ["--rho", "step", "--bleeding", "off"], "sqrt, no bleeding": ["--rho", "sqrt", "--bleeding", "off"],
               "sqrt, bleeding": ["--rho", "sqrt"]}


def flags():
    """Names as obscura info prints them; falloffs are no flags there."""
    text = (ROOT / "kernels/lib/features.clh").read_text(encoding="utf-8")
    return [name.lower() for name in re.findall(r"^#ifndef NEED_(\w+)$", text, re.MULTILINE) if not name.startswith("FALLOFF")]


def kernels_without(flag, folder):
    """A copy of the kernels that lacks the feature, whatever the build options say."""
    kernels = pathlib.Path(folder) / "kernels"
    shutil.copytree(ROOT / "kernels", kernels)
    features = kernels / "lib/features.clh"
    guard = f"#ifndef NEED_{flag.upper()}\n"
    text = features.read_text(encoding="utf-8")
    if guard not in text:
        sys.exit(f"tools/report: kernels/lib/features.clh has no {guard.strip()} any more")
    features.write_text(text.replace(guard, f"#undef NEED_{flag.upper()}\n#define NEED_{flag.upper()} 0\n{guard}"), encoding="utf-8")
    return kernels


class Pricer:
    def __init__(self, program, repeats):
        self.program, self.repeats = program, repeats

    def run(self, arguments, environment):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, env={**os.environ, **environment},
                              check=False)
        if done.returncode != 0:
            sys.exit(f"tools/report: {done.stderr.strip()}")
        return json.loads(done.stdout)

    def needs(self, scene):
        info = self.run(["info", ROOT / "scenes" / scene, "--json", "-"], {})
        return info["needs"]

    def render(self, scene, options, environment, folder):
        return self.run(["render", ROOT / "scenes" / scene, *PICTURE, *options, "-o", pathlib.Path(folder) / "x.exr", "--stats", "-",
                         "--quiet"], environment)

    def compare(self, scene, variants):
        """Two variants, each options and environment: of both what compiling takes and makes, and the medians of the times."""
        with tempfile.TemporaryDirectory() as folder:
            rows = []
            environments = []
            for number, (options, environment) in enumerate(variants):
                caches = {"OBSCURA_CACHE_DIR": f"{folder}/obscura{number}", "POCL_CACHE_DIR": f"{folder}/pocl{number}"}
                environments.append({**environment, **caches})
                seconds = self.render(scene, options, environments[-1], folder)["seconds"]["compile"]
                size = sum(file.stat().st_size for file in pathlib.Path(caches["OBSCURA_CACHE_DIR"]).rglob("*") if file.is_file())
                rows.append({"compile_seconds": seconds, "bytes": size})
            times = []
            for repeat in range(self.repeats):
                pair = {}
                for number in ((0, 1) if repeat % 2 else (1, 0)):
                    kernels = self.render(scene, variants[number][0], environments[number], folder)["kernels"]
                    pair[number] = {"all": sum(row["ms"] for row in kernels.values()),
                                    **{stage: 1e6 * kernels[stage]["ms"] / kernels[stage]["items"]
                                       for stage in STAGES if kernels.get(stage, {}).get("items")}}
                times.append(pair)
        for number, row in enumerate(rows):
            row["kernel_ms"] = statistics.median(pair[number]["all"] for pair in times)
            for stage in STAGES:
                found = [pair[number][stage] for pair in times if stage in pair[number]]
                row[f"{stage}_ns"] = statistics.median(found) if found else None
        return {"base": rows[0], "other": rows[1], "time_ratio": statistics.median(pair[1]["all"] / pair[0]["all"] for pair in times)}

    def price_flags(self, scene):
        needed = self.needs(scene)
        rows = []
        for flag in flags():
            print(f"{scene}: {flag}", file=sys.stderr)
            with tempfile.TemporaryDirectory() as folder:
                without = {"OBSCURA_KERNEL_DIR": str(kernels_without(flag, folder))}
                options = [] if flag in needed else ["--needs", "all"]
                rows.append({"scene": scene, "flag": flag, "needed": flag in needed,
                             **self.compare(scene, [(options, without), (options, {})])})
        return rows

    def price_all(self, scene):
        print(f"{scene}: auto and all", file=sys.stderr)
        return {"scene": scene, **self.compare(scene, [([], {}), (["--needs", "all"], {})])}

    def price_obscurances(self):
        base = OBSCURANCES["step, no bleeding"]
        return [{"obscurances": name, **self.compare(LARGE, [(base, {}), (options, {})])}
                for name, options in OBSCURANCES.items() if options != base]


def cells(row):
    base, other = row["base"], row["other"]
    change = [f"{other['compile_seconds'] - base['compile_seconds']:+.2f}", f"{(other['bytes'] - base['bytes']) / 1024:+.0f}",
              f"{100 * (row['time_ratio'] - 1):+.1f}"]
    for stage in STAGES:
        values = [variant[f"{stage}_ns"] for variant in (base, other)]
        change.append(" to ".join("–" if value is None else f"{value:.0f}" for value in values))
    return change


def markdown(prices):
    columns = ["compiling, s", "programs, KiB", "time of all kernels, %", *(f"{stage}, ns per item" for stage in STAGES)]

    def table(names, rows):
        head = [*names, *columns]
        return ["| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *rows]]

    lines = ["# What features cost", "",
             f"{' '.join(PICTURE)}; compiled cold; median of {prices['repeats']} pairs of renders.", "",
             "## Everything compiled in (`--needs all`), against what the scene needs", "",
             *table(["scene"], [[row["scene"], *cells(row)] for row in prices["all"]]), "",
             "## One feature, against the same without it", "",
             "Needed: beside what else the scene needs, with its work; else beside every feature, without any work.", "",
             *table(["scene", "feature", "needed"], [[row["scene"], row["flag"], "yes" if row["needed"] else "no", *cells(row)]
                                                     for row in prices["flags"]]), "",
             f"## Obscurances of the {LARGE}, against the step without bleeding, which takes any hit", "",
             *table(["obscurances"], [[row["obscurances"], *cells(row)] for row in prices["obscurances"]])]
    return "\n".join(lines) + "\n"


def measure(program, repeats):
    pricer = Pricer(program, repeats)
    return {"repeats": repeats, "all": [pricer.price_all(scene) for scene in [*SMALL, LARGE]],
            "flags": [row for scene in (SMALL[0], LARGE) for row in pricer.price_flags(scene)],
            "obscurances": pricer.price_obscurances()}
