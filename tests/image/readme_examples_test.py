#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# The README's examples run as they stand there: every line of its sh blocks that starts with build/obscura, in
# order, in an empty folder that has only build/obscura and scenes/. All succeed, but for the comparisons of two
# pictures that differ.
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DIFFERENT = ("build/obscura compare cornell.exr flat.exr",  # exit with 1
             "build/obscura compare model.exr light.exr")


def examples():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```sh\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return [line for line in "".join(blocks).splitlines() if line.startswith("build/obscura ")]


class Examples(unittest.TestCase):
    def test_examples_run_as_written(self):
        self.assertGreater(len(examples()), 0)
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "build").mkdir()
            (pathlib.Path(folder) / "build/obscura").symlink_to(os.environ["OBSCURA_PROGRAM"])
            (pathlib.Path(folder) / "scenes").symlink_to(ROOT / "scenes")
            for line in examples():
                result = subprocess.run(shlex.split(line, comments=True), cwd=folder, capture_output=True, text=True, check=False)
                if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
                    self.skipTest("there is no OpenCL device: " + result.stderr)
                expected = 1 if line.startswith(DIFFERENT) else 0
                self.assertEqual(expected, result.returncode, f"{line}\n{result.stdout}{result.stderr}")
                for output in re.findall(r"(?:-o|--preview|--heatmap) (\S+)", line):
                    self.assertTrue((pathlib.Path(folder) / output).stat().st_size > 0, f"{line} wrote no {output}")


if __name__ == "__main__":
    unittest.main()
