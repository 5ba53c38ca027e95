#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# tools/devices-matrix passes a device whose self-test and pictures are right, and no other. Two devices are played by a
# script in the program's place.
import csv
import json
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = """#!/usr/bin/env python3
import json, sys
answers = json.loads(ANSWERS)
command = sys.argv[1]
second = "--device" in sys.argv and sys.argv[sys.argv.index("--device") + 1] == "1"
if command == "devices":
    print(json.dumps({"default": 0, "devices": [
        {"index": i, "usable": True, "platform": f"platform {i}", "name": "device", "driver_version": "1"} for i in (0, 1)]}))
elif command == "check":
    wrong = answers["wrong"] if second else 0
    print(json.dumps({"rays": 1000, "device_wrong": wrong}))
    sys.exit(1 if wrong else 0)
elif command == "render":
    print(json.dumps({"rays": {"camera": 1000, "shadow": answers["shadow"] if second else 1000}}))
    sys.exit(answers["render"] if second else 0)
else:
    print(json.dumps({"pixels": 1000, "differing_pixels": answers["pixels"], "not_finite": answers["not_finite"], "bias": answers["bias"]}))
"""
RIGHT = {"wrong": 0, "shadow": 1001, "render": 0, "pixels": 2, "not_finite": 0, "bias": -1e-6}


class DevicesMatrix(unittest.TestCase):
    def rows(self, **changes):
        """The exit code and the table's rows for a second device that answers like this."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            program = folder / "obscura"
            program.write_text(PROGRAM.replace("ANSWERS", repr(json.dumps(RIGHT | changes))))
            program.chmod(0o755)
            done = subprocess.run([ROOT / "tools/devices-matrix", "--program", program, "--output", folder],
                                  capture_output=True, text=True, check=False)
            with open(folder / "devices.csv", newline="", encoding="utf-8") as file:
                return done.returncode, list(csv.DictReader(file))

    def test_right_device_passes(self):
        code, rows = self.rows()
        self.assertEqual((0, ["pass", "pass"]), (code, [row["result"] for row in rows]))
        self.assertEqual({"rays": "0.0005", "pixels": "0.002", "mean": "-1.0e-06"}, {name: rows[1][name] for name in ("rays", "pixels", "mean")})

    def test_wrong_device_fails(self):
        for wrong in ({"wrong": 1}, {"render": 3}, {"shadow": 1100}, {"pixels": 30}, {"not_finite": 1}, {"bias": 0.002}, {"bias": -0.002}):
            with self.subTest(str(wrong)):
                code, rows = self.rows(**wrong)
                self.assertEqual((1, ["pass", "FAIL"]), (code, [row["result"] for row in rows]))


if __name__ == "__main__":
    unittest.main()
