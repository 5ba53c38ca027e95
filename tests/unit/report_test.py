#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# tools/report oracles writes every row that the device test measured, and refuses a table with a gap or an error.
import csv
import json
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


if __name__ == "__main__":
    unittest.main()
