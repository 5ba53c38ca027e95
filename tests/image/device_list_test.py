#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura render --device A,B` and A/N on the command line: figures, traces, maps and messages of several devices. That the
# pictures are the same to the bit is told in several_devices_test.cpp too, with every cut of the work.
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from interrupting import interrupt

PROGRAM = os.environ["OBSCURA_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = ROOT / "scenes/cornell"
SMALL = ["--width", "64", "--height", "48", "--spp", "8", "--obscurance-rays", "2", "--wave-size", "2048"]


def obscura(*arguments, **environment):
    # Three threads, and as many compute units: a number that doesn't come out even in two.
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False,
                          env={**os.environ, "POCL_MAX_PTHREAD_COUNT": "3", **environment})


def splittable_device():
    """What chooses the default device, which three threads of PoCL make splittable."""
    listed = json.loads(obscura("devices", "--json", "-").stdout)
    for device in listed["devices"]:
        if device.get("index") == listed["default"] is not None and device["max_sub_devices"] >= 3:
            return device
    return None


class DeviceList(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.device = splittable_device()
        if cls.device is None:
            assert os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1", "there is no OpenCL device that can be split"
            raise unittest.SkipTest("there is no OpenCL device that can be split")
        cls.one = str(cls.device["index"])
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.base = cls.folder / "base.exr"
        # Kernels are compiled for each number of units: two here and in the parts below, so that no other is needed.
        result = obscura("render", SCENE, "-o", cls.base, *SMALL, "--device", cls.one, "--stats", cls.folder / "base.json",
                         POCL_MAX_PTHREAD_COUNT="2")
        assert result.returncode == 0, result.stderr

    def render(self, selector, *arguments):
        result = obscura("render", SCENE, "-o", self.folder / "x.exr", *SMALL, "--device", selector,
                         "--stats", self.folder / "x.json", *arguments)
        self.assertEqual(0, result.returncode, result.stderr)
        return result, json.loads((self.folder / "x.json").read_text(encoding="utf-8"))

    def assert_same_picture(self):
        compared = obscura("compare", self.folder / "x.exr", self.base)
        self.assertEqual(0, compared.returncode, compared.stdout + compared.stderr)

    def expect_refusal(self, message, *command):
        result = obscura(*command)
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertRegex(result.stderr, message)
        self.assertNotIn("compiling", result.stderr)

    def test_parts_render_the_picture_of_the_whole(self):
        for parts in (2, 3):
            with self.subTest(parts=parts):
                self.render(f"{self.one}/{parts}")
                self.assert_same_picture()

    def test_statistics_have_a_row_for_each_device(self):
        result, stats = self.render(f"{self.one}/2")
        base = json.loads((self.folder / "base.json").read_text(encoding="utf-8"))
        rows = stats["devices"]
        name = self.device["name"]
        self.assertEqual([f"{name} (1 of 2)", f"{name} (2 of 2)"], [row["device"] for row in rows])
        self.assertEqual(", ".join(row["device"] for row in rows), stats["device"])
        self.assertEqual([2, 1], [row["compute_units"] for row in rows])
        self.assertEqual(base["rays"], stats["rays"])
        for queue, count in stats["rays"].items():
            self.assertEqual(count, sum(row["rays"][queue] for row in rows))
        for category, size in stats["bytes"].items():
            self.assertEqual(size, sum(row["bytes"][category] for row in rows))
        for row in rows:
            self.assertGreater(row["rays"]["camera"], 0)
            share = round(100 * row["rays"]["camera"] / stats["rays"]["camera"])
            self.assertIn(f"{row['device']}: {share} % of the samples", result.stderr)
        self.assertNotIn("devices", base)
        self.assertEqual(set(base) | {"devices"}, set(stats))

    def test_trace_has_a_row_for_each_device(self):
        _, stats = self.render(f"{self.one}/3", "--trace", self.folder / "trace.json")
        self.assert_same_picture()
        events = json.loads((self.folder / "trace.json").read_text(encoding="utf-8"))["traceEvents"]
        names = {event["pid"]: event["args"]["name"] for event in events if event["name"] == "process_name"}
        for process, row in enumerate(stats["devices"], 2):  # 1 is the host
            self.assertEqual(row["device"], names[process])
            launches = [event["name"] for event in events if event["ph"] == "X" and event["pid"] == process]
            for kernel, figures in row["kernels"].items():
                self.assertEqual(figures["launches"], launches.count(kernel), kernel)

    def test_profile_has_tables_for_each_device(self):
        result, stats = self.render(f"{self.one}/3", "--profile", "--heatmap", self.folder / "heat.png")
        for row in stats["devices"]:
            self.assertIn(f"\n{row['device']}\n", "\n" + result.stdout)
            self.assertEqual(set(row["kernels"]), set(row["profile"]["stages"]))
            for queue, visits in row["profile"]["queues"].items():
                self.assertEqual(row["rays"][queue], visits["rays"])
        self.assertEqual(3, result.stdout.count("\nshade "))
        self.assertTrue((self.folder / "heat.png").exists())

    def test_variable_may_name_several(self):
        result = obscura("render", SCENE, "-o", self.folder / "x.exr", *SMALL, OBSCURA_DEVICE=f"{self.one}/3")
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("(3 of 3)", result.stderr)
        self.assert_same_picture()

    def test_wrong_lists_are_refused(self):
        units = self.device["max_sub_devices"]
        for selector, message in ((f"{self.one}/{units + 1}", f"at most {units} sub-devices"), (f"{self.one}/0", "1 or more"),
                                  (f"{self.one},", "empty"), (f"{self.one},{self.one}", "means a device twice"),
                                  (f"{self.one}/2,{self.one}", "means a device twice"), (f"{self.one},nope", '"nope"')):
            with self.subTest(selector):
                self.expect_refusal(message, "render", SCENE, "-o", self.folder / "refused.exr", "--device", selector)
                self.assertFalse((self.folder / "refused.exr").exists())

    def test_commands_for_one_device_say_so(self):
        several = ["--device", f"{self.one}/2"]
        for command in (["check", SCENE], ["check", "--self-test"], ["bench", SCENE], ["sweep", SCENE, "-o", self.folder / "sweep"]):
            with self.subTest(command[0]):
                self.expect_refusal("means several devices; only obscura render", *command, *several)

    def test_failure_names_the_part(self):
        kernels = self.folder / "kernels"
        shutil.copytree(ROOT / "kernels", kernels)
        film = kernels / "film.cl"
        source = film.read_text(encoding="utf-8")
        text = "if (!all_finite(value.xyz))"
        self.assertEqual(1, source.count(text))
        film.write_text(source.replace(text, "if (true)"), encoding="utf-8")
        result = obscura("render", SCENE, "-o", self.folder / "failed.exr", *SMALL, "--device", f"{self.one}/3",
                         OBSCURA_KERNEL_DIR=str(kernels))
        self.assertEqual(3, result.returncode, result.stderr)
        self.assertRegex(result.stderr, r"stage film, .*\(device .* \([123] of 3\)\)")
        self.assertFalse((self.folder / "failed.exr").exists())

    def test_interrupt_stops_all_and_saves_the_picture(self):
        picture = self.folder / "stopped.exr"
        command = [PROGRAM, "render", SCENE, "-o", picture, "--width", "64", "--height", "48", "--obscurance-rays", "1",
                   "--spp", str(1 << 20), "--wave-size", "4096", "--device", f"{self.one}/3"]
        code, _, messages = interrupt(command, "render: ", {"POCL_MAX_PTHREAD_COUNT": "3"})
        self.assertEqual(4, code, messages)
        self.assertIn("the picture is saved with the samples it has", messages)
        compared = obscura("compare", picture, picture)
        self.assertEqual(0, compared.returncode, compared.stderr)


if __name__ == "__main__":
    unittest.main()
