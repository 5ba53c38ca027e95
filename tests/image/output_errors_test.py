#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# A picture that can't be written where it should be is saved elsewhere or, failing that, both reasons are told; one
# output that fails costs none of the others; no temporary file is left.
import os
import pathlib
import resource
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/cornell"
SIZE_LIMIT = 2 << 20  # bytes of a file; the large picture needs more, PoCL's files less


class OutputErrors(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.rescue = self.folder / "rescue"
        self.rescue.mkdir()

    def render(self, *arguments, **more):
        result = subprocess.run([PROGRAM, "render", SCENE, "--spp", "1", "--obscurance-rays", "1", *map(str, arguments)],
                                capture_output=True, text=True, check=False, env={**os.environ, "TMPDIR": str(self.rescue)},
                                **more)
        if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            self.skipTest("there is no OpenCL device: " + result.stderr)
        return result

    def small(self, *arguments):
        return self.render("--width", 32, "--height", 24, *arguments)

    def test_picture_on_a_full_disk_is_saved_under_a_free_name(self):
        for name in ("full.exr", "full-1.exr"):
            result = self.small("-o", "/dev/full", "--stats", self.folder / "stats.json")
            self.assertEqual(2, result.returncode, result.stderr)
            self.assertIn("/dev/full: can't be written: No space left on device; the picture was saved as "
                          f"{self.rescue / name} instead", result.stderr)
            self.assertTrue((self.folder / "stats.json").exists())
        self.small("-o", self.folder / "x.exr")
        for name in ("full.exr", "full-1.exr"):
            compared = subprocess.run([PROGRAM, "compare", self.rescue / name, self.folder / "x.exr"], check=False)
            self.assertEqual(0, compared.returncode)

    def test_two_failures_are_told_in_their_order_and_leave_nothing(self):
        # Python ignores SIGXFSZ, and so does the program then: a file that grows too large is an error like a full disk.
        result = self.render("-o", self.folder / "x.exr", "--width", 800, "--height", 600, "--layers", "all",
                             restore_signals=False,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (SIZE_LIMIT, SIZE_LIMIT)))
        self.assertEqual(2, result.returncode, result.stderr)
        target, rescue = self.folder / "x.exr", self.rescue / "x.exr"
        self.assertRegex(result.stderr, f"{target}: can't be written: File too large; .* elsewhere either: {rescue}: "
                                        "can't be written: File too large")
        self.assertEqual([], [path for path in self.rescue.iterdir() if ".exr" in path.name])
        self.assertEqual([self.rescue], list(self.folder.iterdir()))

    def test_failing_preview_costs_neither_picture_nor_figures(self):
        result = self.small("-o", self.folder / "x.exr", "--preview", "/dev/full", "--stats", self.folder / "x.json")
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertIn("/dev/full: can't be written", result.stderr)
        self.assertTrue((self.folder / "x.exr").exists())
        self.assertTrue((self.folder / "x.json").exists())

    def test_pictures_go_to_files_of_their_kind(self):
        for arguments, message in [
            (["-o", self.folder / "x.png"], "this file is written as .exr"),
            (["-o", self.folder / "x.gltf"], "this file is written as .exr"),
            (["-o", self.folder / "x.exr", "--preview", self.folder / "x.jpg"], "this file is written as .png"),
            (["-o", "-"], "pictures are written to files only"),
            (["-o", ""], "a name is needed"),
        ]:
            result = self.small(*arguments)
            self.assertEqual(2, result.returncode, result.stderr)
            self.assertIn(message, result.stderr)
        self.assertEqual([self.rescue], list(self.folder.iterdir()))

    def test_picture_larger_than_the_memory_is_refused(self):
        result = self.render("-o", self.folder / "x.exr", "--width", 65536, "--height", 65536)
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertRegex(result.stderr, "65536 x 65536 pixels with 8 layers take .* of memory, and this machine has")


if __name__ == "__main__":
    unittest.main()
