#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura sweep`: its figures are those of obscura render and obscura compare, whatever is interrupted is gone on with to
# the same figures, and what doesn't belong together is refused.
import csv
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

from interrupting import interrupt

PROGRAM = os.environ["OBSCURA_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = ROOT / "scenes/cornell"
SIZE = ["--width", "16", "--height", "12"]
KEYS = {"budget", "seconds", "rays", "rmse", "relmse", "mape", "bias", "bias_standard_error", "efficiency", "rms_bias",
        "variance"}


def obscura(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def timeless(value):
    """Without what depends on the clock."""
    if isinstance(value, dict):
        return {key: timeless(item) for key, item in value.items() if "seconds" not in key and key != "efficiency"}
    return [timeless(item) for item in value] if isinstance(value, list) else value


class Sweep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.all = cls.folder / "all"
        result = cls.sweep(cls.all, "--json", "-")
        if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            raise unittest.SkipTest("there is no OpenCL device: " + result.stderr)
        assert result.returncode == 0, result.stderr
        cls.printed = json.loads(result.stdout)
        cls.results = json.loads((cls.all / "sweep.json").read_text())

    @staticmethod
    def sweep(folder, *arguments, budgets=2, seeds=2):
        return obscura("sweep", SCENE, "-o", folder, *SIZE, "--budgets", budgets, "--seeds", seeds, "--quiet", *arguments)

    def refused(self, message, *arguments, **options):
        result = self.sweep(*arguments, **options)
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertIn(message, result.stderr)

    def test_json_holds_every_method_with_every_budget(self):
        self.assertEqual(self.results, self.printed)
        listed = obscura("sweep", "--help").stdout.split("Methods:\n")[1].split("The methods set")[0]
        self.assertEqual([line.split()[0] for line in listed.splitlines()], list(self.results["methods"]))
        for name, rows in self.results["methods"].items():
            with self.subTest(name):
                self.assertEqual(2, len(rows))
                self.assertEqual(2, rows[1]["budget"] / rows[0]["budget"])
                for row in rows:
                    self.assertLessEqual(KEYS, set(row))
                    self.assertGreater(row["seconds"], 0)
                    self.assertGreater(row["rays"], 16 * 12)
                    self.assertLess(row["rmse_low"], row["rmse_high"])
                    sampling = self.results["measured_against"][name] == "obscurance"
                    self.assertEqual(["diffuse", *(["obscurance"] if sampling else [])], list(row["layers"]))
        self.assertEqual({"lattice", "owen"}, set(self.results["variance_ratio_to_random"]))
        self.assertIn("obscurance", self.results["overtaking"])
        for reference in self.results["references"].values():
            self.assertEqual((16 * 4, 16), (reference["samples_per_pixel"], reference["independent_sets"]))

    def test_features_that_are_not_needed_change_no_error(self):
        for pruned, everything in zip(self.results["methods"]["lattice"], self.results["methods"]["needs-all"]):
            self.assertEqual(timeless(pruned), timeless(everything))

    def test_csv_holds_the_same_figures(self):
        with open(self.all / "sweep.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(sum(1 + len(row["layers"]) for method in self.results["methods"].values() for row in method), len(rows))
        row = next(row for row in rows if (row["method"], row["budget"], row["layer"]) == ("owen", "10", "diffuse"))
        for name, value in self.results["methods"]["owen"][1]["layers"]["diffuse"].items():
            self.assertAlmostEqual(1, float(row[name]) / value if value else 1, 4, name)

    def test_errors_are_those_of_render_and_compare(self):
        record = json.loads((self.all / "runs.json").read_text())["results"]
        for method, options in (("owen", ["--sampler", "owen"]), ("lattice", [])):
            found = next(row for row in record if (row["method"], row["budget"]) == (method, 10))
            for seed, run in enumerate(found["runs"]):
                picture = self.folder / "picture.exr"
                stats = json.loads(obscura("render", SCENE, "-o", picture, *SIZE, "--spp", 2, "--seed", seed, "--stats", "-",
                                           *options).stdout)
                self.assertEqual(sum(stats["rays"].values()), run["rays"])
                expected = json.loads(obscura("compare", picture, self.all / "obscurance.exr", "--layer", "obscurance",
                                              "--json", "-").stdout)
                for name, value in zip(("mse", "relmse", "mape", "bias"), run["errors"]["obscurance"]):
                    self.assertAlmostEqual(1, value / expected[name], 9, f"{method}, {name}")

    def test_pictures_are_there_for_the_page(self):
        pictures = {path.name for path in (self.all / "pictures").iterdir()}
        self.assertLessEqual({"lattice-5.png", "k10-20.png", "path-10.png", "reference-path.png"}, pictures)

    def test_what_is_done_is_not_done_again(self):
        before = (self.all / "runs.json").read_bytes()
        times = {path: path.stat().st_mtime_ns for path in self.all.rglob("*-5.png")}
        self.assertEqual(0, self.sweep(self.all).returncode)
        self.assertEqual(before, (self.all / "runs.json").read_bytes())
        self.assertEqual(times, {path: path.stat().st_mtime_ns for path in self.all.rglob("*-5.png")})
        self.assertEqual(timeless(self.results), timeless(json.loads((self.all / "sweep.json").read_text())))

    def test_interrupted_sweep_goes_on_to_the_same_figures(self):
        folder = self.folder / "interrupted"
        chosen = ["--methods", "lattice,path", "--reference-dir", self.folder / "shared"]
        options = {"budgets": 3, "seeds": 41}
        whole = self.folder / "whole"
        self.assertEqual(0, self.sweep(whole, *chosen, **options).returncode)
        expected = json.loads((whole / "sweep.json").read_text())

        command = [PROGRAM, "sweep", SCENE, "-o", folder, *SIZE, "--budgets", "3", "--seeds", "41", *chosen]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            deadline = time.monotonic() + 240
            while not (folder / "pictures/path-10.png").exists() and time.monotonic() < deadline:
                time.sleep(0.002)
            process.send_signal(signal.SIGINT)
            messages = process.communicate(timeout=240)[1]
        finally:
            process.kill()
            process.wait()
        self.assertEqual(4, process.returncode, messages)
        self.assertIn("the same command goes on with it", messages)
        partial = json.loads((folder / "sweep.json").read_text())
        self.assertFalse(partial["complete"])
        self.assertLess(len(json.loads((folder / "runs.json").read_text())["results"]), 2 * 3 * 21)

        self.assertEqual(0, self.sweep(folder, *chosen, **options).returncode)
        self.assertEqual(timeless(expected["methods"]),
                         timeless(json.loads((folder / "sweep.json").read_text())["methods"]))

    def test_interrupted_reference_is_gone_on_with(self):
        folder = self.folder / "reference"
        command = [PROGRAM, "sweep", SCENE, "-o", folder, "--methods", "owen", "--width", "100", "--height", "75", "--budgets",
                   "8", "--seeds", "2"]
        code, output, messages = interrupt(command, "reference obscurance: ")  # the first report of progress
        self.assertEqual((4, ""), (code, output), messages)
        header = obscura("compare", folder / "obscurance.exr", folder / "obscurance.exr", "--json", "-")
        self.assertEqual(0, header.returncode, header.stderr)
        self.assertFalse((folder / "runs.json").exists())

    def test_seeds_and_methods_can_be_added(self):
        folder = self.folder / "grown"
        self.assertEqual(0, self.sweep(folder, "--methods", "owen", seeds=1).returncode)
        self.assertEqual(None, json.loads((folder / "sweep.json").read_text())["methods"]["owen"][0]["variance"])
        self.assertEqual(0, self.sweep(folder, "--methods", "owen,lattice", seeds=2).returncode)
        grown = json.loads((folder / "sweep.json").read_text())["methods"]
        self.assertEqual(["lattice", "owen"], list(grown))
        for name, rows in grown.items():
            self.assertEqual(timeless(self.results["methods"][name]), timeless(rows))

    def test_other_settings_are_refused_in_the_same_folder(self):
        self.refused('it was made with rho "exp", not "sqrt"', self.all, "--rho", "sqrt", "--methods", "none",
                     "--reference-dir", self.folder / "sqrt")
        self.refused("was made with another --rho", self.all, "--rho", "sqrt")
        self.refused("was made with another --spp", self.folder / "x", "--reference-dir", self.all, budgets=3)

    def test_wrong_input_is_refused(self):
        folder = self.folder / "refused"
        self.refused("there is no such method; choose from lattice, owen", folder, "--methods", "sobol")
        self.refused("is not a whole number from 1", folder, seeds=0)
        self.refused("is not a whole number from 1", folder, budgets=13)
        for option in (["--spp", "4"], ["--sampler", "owen"], ["--no-direct"], ["--needs", "all"]):
            self.refused(f"{option[0]}: the methods of a sweep set it themselves", folder, *option)
        self.assertFalse(folder.exists())
        broken = self.folder / "broken"
        broken.mkdir()
        (broken / "runs.json").write_text("{}")
        self.refused("it is no record of a sweep", broken, "--methods", "owen")


if __name__ == "__main__":
    unittest.main()
