#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# tools/report oracles writes every row that the device test measured, and refuses a table with a gap or an error;
# tools/report sweep makes a page of plots, pictures and tables that needs nothing else.
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
GEOMETRIES, FALLOFFS, REACHES = ["plane", "sphere, diameter 1"], ["step", "exp:5"], [0.5, 1]


def table():
    rows = [
        {"geometry": geometry, "rho": rho, "d_max": d_max, "value": 0.502, "closed_form": [0.5, 0.501],
         "standard_error": 0.0004, "z": 2.5}
        for geometry in GEOMETRIES for rho in FALLOFFS for d_max in REACHES
    ]
    return {"device": "a device", "sampler": "owen", "rays": 1 << 20, "randomisations": 16, "rounding": 2.5e-7,
            "z_limit": 4.5, "geometries": GEOMETRIES, "falloffs": FALLOFFS, "d_max": REACHES, "rows": rows}


class Oracles(unittest.TestCase):
    def report(self, document):
        """Exit code, what was said, and the rows of the CSV if there is one."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            source = folder / "oracles.json"
            if document is not None:
                source.write_text(json.dumps(document))
            done = subprocess.run([ROOT / "tools/report", "oracles", "--table", source, "--out", folder / "out"],
                                  capture_output=True, text=True, check=False)
            if not (folder / "out/oracles.csv").exists():
                return done.returncode, done.stderr, []
            with open(folder / "out/oracles.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            markdown = (folder / "out/oracles.md").read_text()
            for row in rows:
                self.assertIn("| " + " | ".join(row.values()) + " |", markdown)
            return done.returncode, done.stderr, rows

    def test_complete_table_is_written(self):
        code, said, rows = self.report(table())
        self.assertEqual((0, "", 8), (code, said, len(rows)))
        self.assertEqual({"geometry": "sphere, diameter 1", "rho": "exp:5", "d_max": "1", "value": "0.502000000",
                          "closed_form": "0.500500000", "tessellation": "5.00e-04", "error": "1.50e-03",
                          "standard_error": "4.00e-04", "z": "2.50"}, rows[-1])

    def test_gap_is_refused(self):
        document = table()
        document["rows"].pop(3)
        code, said, rows = self.report(document)
        self.assertEqual((1, []), (code, rows))
        self.assertIn("0 rows of plane, exp:5, 1", said)

    def test_doubled_row_is_refused(self):
        document = table()
        document["rows"].append(document["rows"][0])
        code, said, _ = self.report(document)
        self.assertEqual(1, code)
        self.assertIn("2 rows of plane, step, 0.5", said)

    def test_error_beyond_the_limit_is_told(self):
        # JSON has no infinity: null is an error that no variance explains.
        for z in (4.6, -4.6, None):
            document = table()
            document["rows"][2]["z"] = z
            code, said, rows = self.report(document)
            self.assertEqual((1, 8), (code, len(rows)))
            self.assertIn("beyond: plane, exp:5, 0.5", said)

    def test_missing_table_names_its_source(self):
        code, said, _ = self.report(None)
        self.assertEqual(1, code)
        self.assertIn("tools/test -R Oracle.Owen writes it", said)


def errors(rmse):
    """The figures of a layer, all of them telling nothing but their RMSE."""
    names = ["relmse", "mape", "bias", "rms_bias", "variance"]
    spread = {f"{name}{end}": 0.01 for name in names for end in ("", "_low", "_high")}
    return {**spread, "rmse": rmse, "rmse_low": 0.9 * rmse, "rmse_high": 1.1 * rmse, "bias_standard_error": 0.01,
            "efficiency": None, "reference_share": 0.02}


def sweep_results():
    """Two budgets of a sampler, a model and path tracing."""
    def rows(seconds, sampling):
        layers = {"diffuse": errors(0.02), **({"obscurance": errors(0.03)} if sampling else {})}
        return [{"budget": budget, "samples_per_pixel": budget // 5, "runs": 10, "seconds": seconds * budget,
                 "seconds_min": seconds * budget, "seconds_max": seconds * budget, "rays": 1000.0 * budget,
                 **errors(0.5 / budget), "layers": layers} for budget in (5, 10)]

    fit = {"exponent": -0.77, "low": -0.8, "high": -0.7}
    floor = {"floor": 0.0123, "floor_low": 0.01, "floor_high": 0.02, "path_better_after_seconds": 4.56,
             "path_better_after_rays": None}
    names = {"lattice": "obscurance", "needs-all": "obscurance", "ao": "path", "path": "path"}
    return {"scene": "a <scene>.gltf", "device": "a device", "width": 8, "height": 6, "seeds": 10, "complete": True,
            "references": {"path": {"samples_per_pixel": 64, "independent_sets": 16, "seconds": 9.0, "tracer": "a tracer",
                                    "standard_error": {"beauty": 0.001}}},
            "methods": {name: rows(2.0 if name == "needs-all" else 1.0, kind == "obscurance") for name, kind in names.items()},
            "meaning": dict.fromkeys(names, "what it is"), "measured_against": names,
            "convergence": {name: {"diffuse": {"rays": fit, "seconds": None}} for name in names},
            "overtaking": {"ao": floor},
            "variance_ratio_to_random": {"lattice": [{"budget": 5, "layer": "obscurance", "ratio": 7.89}]}}


BLACK_PNG = bytes.fromhex("89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c63"
                          "6060600000000400017689b2a60000000049454e44ae426082")
# The package's interface: reference, picture, range, is it sRGB, colour map, mean, settings.
FLIP_STAND_IN = """
def evaluate(reference, picture, kind, srgb, magma, mean, settings):
    assert (kind, srgb, magma, mean, settings) == ("LDR", True, False, True, {"ppd": 67}), "other settings"
    assert reference.shape == picture.shape == (1, 1, 3) and reference.dtype == picture.dtype == "float32"
    return None, 0.1234, settings
"""
PRICE = {"compile_cpu_seconds": 1.5, "bytes": 2048, "ns": {"shade": 321}}
NEEDS = {"repeats": 9, "device": "a device", "obscurances": [], "flags": [],
         "all": [{"scene": "furnace", "base": PRICE, "other": PRICE, "cpu_ratio": [1.1, 1.05, 1.15]}]}


class SweepPage(unittest.TestCase):
    def report(self, document, *options, beside=None, modules=None):
        """Exit code, what was said, and the page if there is one. beside: other files of the folder, modules: Python's, by name."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "pictures").mkdir()
            for picture in ("reference-path", "ao-5"):
                (folder / f"pictures/{picture}.png").write_bytes(BLACK_PNG)
            # A module of this name that can't be imported stands for a package that isn't there.
            missing = 'raise ModuleNotFoundError("No module named flip_evaluator")'
            for file, text in {"modules/flip_evaluator.py": missing, **(modules or {}), **(beside or {})}.items():
                (folder / file).parent.mkdir(exist_ok=True)
                (folder / file).write_text(text)
            if document is not None:
                (folder / "sweep.json").write_text(json.dumps(document))
                (folder / "sweep.csv").write_text("method")
            done = subprocess.run([ROOT / "tools/report", "sweep", folder, "--out", folder / "out", *options],
                                  capture_output=True, text=True, check=False,
                                  env={**os.environ, "PYTHONPATH": str(folder / "modules")})
            written = {path.name: path.read_bytes() for path in (folder / "out").glob("*")}
            return done.returncode, done.stderr, written

    def test_page_holds_plots_pictures_and_figures(self):
        code, said, written = self.report(sweep_results())
        self.assertEqual((0, ""), (code, said))
        self.assertEqual({"sweep.html", "sweep.png", "sweep.json", "sweep.csv"}, set(written))
        page = written["sweep.html"].decode()
        self.assertEqual(4, page.count("<svg"))
        for text in ("a &lt;scene&gt;.gltf", "lattice, slope -0.77", "0.0123 (0.01 to 0.02)", "4.56 s", "7.89", "a device",
                     "64 spp in 16 sets", "data:image/png;base64,", "reference: path", "<td>2.00</td>"):
            self.assertIn(text, page)
        self.assertNotIn("src=\"http", page)
        self.assertNotIn("href=\"http", page)
        self.assertTrue(written["sweep.png"].startswith(b"\x89PNG"))

    def test_page_without_the_package_of_flip_tells_how_to_get_it(self):
        page = self.report(sweep_results())[2]["sweep.html"].decode()
        self.assertIn("pip install flip-evaluator", page)

    def test_page_holds_flip_of_pictures_beside_their_reference(self):
        code, said, written = self.report(sweep_results(), modules={"modules/flip_evaluator.py": FLIP_STAND_IN})
        self.assertEqual((0, ""), (code, said))
        page = written["sweep.html"].decode()
        self.assertEqual(5, page.count("<svg"))
        self.assertIn("<td>ao</td><td>path</td><td>0.1234</td>", page)  # the one budget whose picture is there
        self.assertNotIn("flip-evaluator", page)

    def test_page_holds_prices_of_features_and_remedies(self):
        remedies = "remedy,stage,added\nexact differences,obscurance,+3.5\n"
        code, said, written = self.report(sweep_results(), beside={"needs.json": json.dumps(NEEDS), "remedies.csv": remedies})
        self.assertEqual((0, ""), (code, said))
        page = written["sweep.html"].decode()
        for text in ("<td>furnace</td><td>+0.0</td><td>+0</td><td>+10.0 (+5.0 to +15.0)</td><td>321 to 321</td>",
                     "<td>exact differences</td><td>obscurance</td><td>+3.5</td>"):
            self.assertIn(text, page)

    def test_unfinished_sweep_says_so(self):
        page = self.report({**sweep_results(), "complete": False})[2]["sweep.html"].decode()
        self.assertIn("stopped early", page)

    def test_missing_sweep_and_wrong_window_are_refused(self):
        code, said, _ = self.report(None)
        self.assertEqual(1, code)
        self.assertIn("obscura sweep SCENE -o", said)
        code, said, _ = self.report(sweep_results(), "--crop", "0.5,0.4,0,1")
        self.assertEqual(2, code)
        self.assertIn("x0,x1,y0,y1", said)


if __name__ == "__main__":
    unittest.main()
