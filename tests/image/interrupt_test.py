#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Ctrl-C: a render that is under way saves what it has, says so in the header, and exits with 4; one that has not begun
# leaves an earlier picture alone.
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

from interrupting import interrupt

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/cornell"
PLANNED = 1 << 20  # hours of work


def header(path):
    """The attributes of an EXR header: name -> bytes of the value."""
    data = path.read_bytes()
    attributes, place = {}, 8  # after magic and version
    while data[place]:
        name, place = data[place : data.index(0, place)].decode(), data.index(0, place) + 1
        place = data.index(0, place) + 1  # the type's name
        size = struct.unpack_from("<i", data, place)[0]
        attributes[name] = data[place + 4 : place + 4 + size]
        place += 4 + size
    return attributes


class Interrupt(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def stop(self, line_start, environment=None):
        """The messages of a render to x.exr that was interrupted when one began so."""
        command = [PROGRAM, "render", SCENE, "-o", self.folder / "x.exr", "--width", "64", "--height", "48", "--obscurance-rays",
                   "1", "--spp", str(PLANNED), "--wave-size", "4096"]
        code, _, messages = interrupt(command, line_start, environment)
        if code == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            self.skipTest("there is no OpenCL device: " + messages)
        self.assertEqual(4, code, messages)
        return messages

    def test_render_under_way_saves_a_whole_picture_with_the_samples_it_has(self):
        messages = self.stop("render: ")  # the first report of progress
        self.assertIn("the picture is saved with the samples it has", messages)
        picture = self.folder / "x.exr"
        self.assertEqual([picture], list(self.folder.iterdir()))
        # `compare` reads every scan line.
        compared = subprocess.run([PROGRAM, "compare", picture, picture], capture_output=True, text=True, check=False)
        self.assertEqual(0, compared.returncode, compared.stderr)
        attributes = header(picture)
        self.assertEqual(b"no", attributes["complete"])
        self.assertEqual(PLANNED, struct.unpack("<i", attributes["plannedSamplesPerPixel"])[0])
        taken = struct.unpack("<i", attributes["samplesPerPixel"])[0]
        self.assertGreater(taken, 0)
        self.assertLess(taken, PLANNED)

    def test_render_that_has_not_begun_keeps_an_earlier_picture(self):
        (self.folder / "x.exr").write_text("an earlier picture", encoding="utf-8")
        with tempfile.TemporaryDirectory() as cache:  # without compiled kernels there is time before the first wave
            messages = self.stop(SCENE.name, {"OBSCURA_CACHE_DIR": cache, "POCL_CACHE_DIR": cache})
        self.assertIn("no picture is written", messages)
        self.assertEqual("an earlier picture", (self.folder / "x.exr").read_text(encoding="utf-8"))
        self.assertEqual(1, len(list(self.folder.iterdir())))


if __name__ == "__main__":
    unittest.main()
