#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# The self-test and small renders on Mesa's rusticl with llvmpipe: another compiler, another driver, the portable form
# of the kernels. Where it is installed it must not become the default device.
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["OBSCURA_PROGRAM"]
ENVIRONMENT = {**os.environ, "RUSTICL_ENABLE": "llvmpipe"}
ENVIRONMENT.pop("OBSCURA_DEVICE", None)
RENDER = ["--width", "16", "--height", "16", "--spp", "4", "--obscurance-rays", "2", "--quiet"]


def run(*command):
    return subprocess.run([str(word) for word in (PROGRAM, *command)], capture_output=True, text=True, check=False, env=ENVIRONMENT)


def devices():
    return json.loads(run("devices", "--json", "-").stdout)


class Rusticl(unittest.TestCase):
    def setUp(self):
        found = [row for row in devices()["devices"] if row["platform"] == "rusticl" and row["usable"]]
        if not found:
            if os.environ.get("OBSCURA_REQUIRE_DEVICE") == "1":
                self.fail("rusticl has no usable device (tools/deps devices)")
            self.skipTest("rusticl has no usable device (tools/deps devices)")
        self.device = str(found[0]["index"])

    def test_pocl_stays_the_default(self):
        listed = devices()
        default = next(row for row in listed["devices"] if row.get("index") == listed["default"])
        self.assertEqual("Portable Computing Language", default["platform"])

    def test_self_test(self):
        done = run("check", "--self-test", "--device", self.device, "--json", "-")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertEqual(0, json.loads(done.stdout)["device_wrong"])

    def assert_differs_little(self, scene, *arguments):
        """A render with these arguments from one on the default device."""
        with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
            pictures = [pathlib.Path(folder) / f"{name}.exr" for name in ("other", "default")]
            for picture, more in zip(pictures, (arguments, [])):
                done = run("render", ROOT / "scenes" / scene, "-o", picture, *RENDER, *more)
                self.assertEqual(0, done.returncode, done.stderr)
            difference = json.loads(run("compare", *pictures, "--json", "-").stdout)
            self.assertEqual(0, difference["not_finite"])
            self.assertLessEqual(difference["differing_pixels"], 0.02 * difference["pixels"])
            self.assertLess(abs(difference["bias"]), 1e-3)

    def test_small_renders_differ_little(self):
        for scene in ("cornell", "planes", "wall", "sphere", "furnace"):
            self.assert_differs_little(scene, "--device", self.device)

    def test_render_shared_with_the_default_device_differs_little(self):
        with tempfile.TemporaryDirectory() as folder:
            stats = pathlib.Path(folder) / "stats.json"
            default = devices()["default"]
            self.assert_differs_little("cornell", "--device", f"{default},{self.device}", "--wave-size", "64", "--stats", stats)
            rows = json.loads(stats.read_text(encoding="utf-8"))["devices"]
        self.assertEqual([True, True], [row["rays"]["camera"] > 0 for row in rows])


if __name__ == "__main__":
    unittest.main(verbosity=2)
