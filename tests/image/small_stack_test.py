#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Kernels run on stacks of 2 MiB, a quarter of what threads have by default: PoCL could keep a kernel's own variables once
# for each work-item of a group, and streams of rays are large.
import os
import pathlib
import resource
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/kitchen"
STACK = 2 << 20  # bytes


def limit_stack():
    resource.setrlimit(resource.RLIMIT_STACK, (STACK, STACK))


class SmallStack(unittest.TestCase):
    def run_command(self, *arguments, **more):
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, **more)
        if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            self.skipTest("there is no OpenCL device: " + result.stderr)
        self.assertEqual(0, result.returncode, result.stderr)

    def test_render_and_check(self):
        size = ["--width", 120, "--height", 90, "--spp", 2]
        with tempfile.TemporaryDirectory() as folder:
            render = ["render", SCENE, *size, "-o", f"{folder}/x.exr"]
            self.run_command(*render)  # compiles: that needs more stack
            self.run_command(*render, preexec_fn=limit_stack)
        self.run_command("check", SCENE, *size)
        self.run_command("check", SCENE, *size, preexec_fn=limit_stack)


if __name__ == "__main__":
    unittest.main()
