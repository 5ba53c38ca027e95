#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# obscura reference as a program: what each option changes or is refused for, threads that change nothing, Ctrl-C that
# saves, and --resume that goes on exactly.
import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import tempfile
import time
import unittest

from interrupt_test import header
from options_test import CHANGES_PICTURE, write_room

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SMALL = ["--width", "24", "--height", "18", "--spp", "4", "--sets", "3"]
# Not of paths, which trace all light.
OBSCURANCE_ONLY = {
    "--obscurance-rays --ao-samples", "--rho --falloff", "--dmax --ao-distance", "--ambient", "--bleeding", "--no-direct",
    "--no-specular", "--no-obscurance", "--ambient-light", "--ambient-scale", "--max-depth", "--roulette",
}
OF_THE_FILE = {"--exr-half"}  # an option of render that is no option here
OWN = {"--integrator": ["--integrator", "path"], "--sets": ["--sets", "4"]}
# Each has its own test below.
OTHERS = {"--width", "--height", "--cropwindow", "--output --outfile", "--resume", "--quiet"}


def obscura(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, **options)


class ReferenceCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        cls.scene = cls.folder / "room.gltf"
        write_room(cls.scene)
        for name, arguments in (("base", []), ("path", ["--integrator", "path"])):
            result = obscura("reference", cls.scene, "-o", cls.folder / f"{name}.exr", *SMALL, *arguments)
            assert result.returncode == 0, result.stderr

    def reference(self, name, *arguments, code=0, **options):
        kept = [word for i in range(0, len(SMALL), 2) if SMALL[i] not in arguments for word in SMALL[i : i + 2]]
        result = obscura("reference", self.scene, "-o", self.folder / f"{name}.exr", *kept, *arguments, **options)
        self.assertEqual(code, result.returncode, result.stderr)
        return result

    def differs(self, name, other, *arguments):
        result = obscura("compare", self.folder / f"{name}.exr", self.folder / f"{other}.exr", *arguments)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return result.returncode == 1

    def layers(self, name):
        file = self.folder / f"{name}.exr"
        return set(json.loads(obscura("compare", file, file, "--json", "-").stdout)["layers"])

    def test_every_option_has_a_case(self):
        listed = set()
        for line in obscura("reference", "--help").stdout.splitlines():
            match = re.match(r"\s+((?:-\w,)?--[a-z-]+(?:,--[a-z-]+)*)\b", line)
            if match:
                listed.add(" ".join(name for name in match.group(1).split(",") if name.startswith("--")))
        self.assertEqual(listed - {"--help"}, (set(CHANGES_PICTURE) - OF_THE_FILE) | set(OWN) | OTHERS)
        self.assertLess(OBSCURANCE_ONLY, set(CHANGES_PICTURE))

    def test_options_change_the_picture(self):
        for spellings, arguments in {**CHANGES_PICTURE, **OWN}.items():
            if spellings in OF_THE_FILE:
                continue
            with self.subTest(spellings):
                self.reference("changed", *arguments)
                self.assertTrue(self.differs("changed", "base", "--layer", "beauty"), "the picture is the same")

    def test_path_tracing_takes_or_refuses_each_option(self):
        for spellings, arguments in CHANGES_PICTURE.items():
            if spellings in OF_THE_FILE:
                continue
            with self.subTest(spellings):
                if spellings in OBSCURANCE_ONLY:
                    for spelling in spellings.split():
                        result = self.reference("refused", "--integrator", "path", spelling, *arguments[1:], code=2)
                        self.assertIn(f"{spellings.split()[0]} says nothing to --integrator path", result.stderr)
                    self.assertFalse((self.folder / "refused.exr").exists())
                else:
                    self.reference("changed", "--integrator", "path", *arguments)
                    self.assertTrue(self.differs("changed", "path", "--layer", "beauty"), "the picture is the same")

    def test_pictures_beyond_the_memory_are_refused(self):
        result = self.reference("huge", "--width", "65536", "--height", "65536", code=2)
        self.assertIn("65536 x 65536 pixels take ", result.stderr)

    def test_options_of_a_device_are_unknown(self):
        for option in (["--device", "0"], ["--wave-size", "64"], ["--layers", "all"], ["--needs", "all"]):
            self.reference("refused", *option, code=2)

    def test_size_and_crop_choose_the_pixels(self):
        self.reference("crop", "--cropwindow", "0,0.5,0,1")
        self.reference("rest", "--cropwindow", "0.5,1,0,1")
        merged = obscura("merge", self.folder / "crop.exr", self.folder / "rest.exr", "-o", self.folder / "both.exr")
        self.assertEqual(0, merged.returncode, merged.stderr)
        self.assertFalse(self.differs("both", "base"))

    def test_quiet_prints_nothing(self):
        self.assertEqual("", self.reference("quiet", "--quiet").stderr)

    def test_layers_partition_the_picture_and_tell_its_variance(self):
        parts = {"emission", "direct", "ambient", "specular.emission", "specular.direct", "specular.ambient"}
        state = {"state.high", "state.low"}
        always = state | {"beauty", "diffuse"}
        variances = {"Variance", "Variance.diffuse"}
        self.assertEqual(always | parts | variances | {"obscurance", "Variance.obscurance"}, self.layers("base"))
        self.assertEqual(always | variances, self.layers("path"))
        result = self.reference("single", "--sets", "1")
        self.assertEqual(always | parts | {"obscurance"}, self.layers("single"))
        self.assertIn("there is no layer Variance", result.stderr)

    def test_threads_change_nothing(self):
        one = {min(os.sched_getaffinity(0))}
        for name in ("base", "path"):
            self.reference("alone", "--integrator", "path" if name == "path" else "obscurance",
                           preexec_fn=lambda: os.sched_setaffinity(0, one))
            self.assertFalse(self.differs("alone", name))

    def test_resume_goes_on_exactly(self):
        for name in ("obscurance", "path"):
            self.reference("parts", "--integrator", name, "--sets", "1")
            self.reference("parts", "--integrator", name, "--sets", "2", "--resume")
            self.reference("parts", "--integrator", name, "--resume")
            self.assertFalse(self.differs("parts", {"obscurance": "base", "path": "path"}[name]))

    def test_resume_refuses_what_was_made_differently(self):
        picture = (self.folder / "base.exr").read_bytes()
        (self.folder / "old.exr").write_bytes(picture)
        changes = [value for spellings, value in CHANGES_PICTURE.items() if spellings not in OF_THE_FILE]
        changes += [["--integrator", "path"], ["--width", "23"], ["--cropwindow", "0,0.5,0,1"], ["--sets", "2"]]
        for arguments in changes:
            with self.subTest(" ".join(arguments)):
                result = self.reference("old", "--resume", *arguments, code=2)
                self.assertRegex(result.stderr, f"--resume: {self.folder / 'old.exr'} (was made with another|has) .*"
                                                f"{arguments[0]}\\b")
                self.assertEqual(picture, (self.folder / "old.exr").read_bytes())

    def test_resume_refuses_another_scene_and_no_picture(self):
        (self.folder / "old.exr").write_bytes((self.folder / "base.exr").read_bytes())
        moved = json.loads(self.scene.read_text(encoding="utf-8"))
        moved["materials"][1]["pbrMetallicRoughness"]["roughnessFactor"] = 0.9
        moved["materials"][2]["pbrMetallicRoughness"]["roughnessFactor"] = 0.9
        other = self.folder / "other"
        other.mkdir()
        (other / "room.gltf").write_text(json.dumps(moved), encoding="utf-8")
        result = obscura("reference", other / "room.gltf", "-o", self.folder / "old.exr", *SMALL, "--resume")
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertIn(f"--resume: {self.folder / 'old.exr'} was made from another scene", result.stderr)
        self.reference("missing", "--resume", code=2)
        rendered = self.folder / "text.exr"
        rendered.write_text("no picture", encoding="utf-8")
        self.reference("text", "--resume", code=2)

    def test_resume_leaves_a_complete_picture_as_it_is(self):
        picture = (self.folder / "base.exr").read_bytes()
        (self.folder / "done.exr").write_bytes(picture)
        result = self.reference("done", "--resume")
        self.assertIn("done.exr is complete already", result.stderr)
        self.assertNotIn("wrote", result.stderr)
        self.assertEqual(picture, (self.folder / "done.exr").read_bytes())

    def test_resume_refuses_a_picture_of_render(self):
        rendered = obscura("render", self.scene, "-o", self.folder / "rendered.exr", *SMALL[:-2])
        if rendered.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            self.skipTest("there is no OpenCL device: " + rendered.stderr)
        result = self.reference("rendered", "--resume", code=2)
        self.assertIn("was not made by obscura reference, but by obscura render", result.stderr)

    def test_interruption_saves_and_resume_ends_with_the_unbroken_picture(self):
        command = [PROGRAM, "reference", self.scene, "-o", self.folder / "stopped.exr", *SMALL[:-1], str(1 << 20)]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        try:
            messages = process.stderr.readline()  # the scene's line: the render begins
            time.sleep(0.7)
            process.send_signal(signal.SIGINT)
            messages += process.communicate(timeout=240)[1]
        finally:
            process.kill()
            process.wait()
        self.assertEqual(4, process.returncode, messages)
        self.assertIn("--resume goes on with it", messages)
        attributes = header(self.folder / "stopped.exr")
        self.assertEqual(b"no", attributes["complete"])
        passes = struct.unpack("<i", attributes["samplesPerPixel"])[0]
        sets = ["--sets", str(passes // 4 + 1)]
        self.reference("stopped", *sets, "--resume")
        self.assertEqual(b"yes", header(self.folder / "stopped.exr")["complete"])
        self.reference("unbroken", *sets)
        self.assertFalse(self.differs("stopped", "unbroken"))


if __name__ == "__main__":
    unittest.main()
