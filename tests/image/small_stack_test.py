#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Kernels run on stacks of 2 MiB, a quarter of what threads have by default: PoCL could keep a kernel's own variables once
# for each work-item of a group, and streams of rays are large. What is beyond a stack may be another's, so that a run
# alone could go well: the compiled kernels are looked at, too.
import os
import pathlib
import re
import resource
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/kitchen"
STACK = 2 << 20  # bytes


def limit_stack():
    resource.setrlimit(resource.RLIMIT_STACK, (STACK, STACK))


def largest_frame(library):
    """Bytes of stack that a function of a library takes; x86 only, elsewhere 0."""
    listing = subprocess.run(["objdump", "-d", "--no-show-raw-insn", str(library)], capture_output=True, text=True, check=True)
    frames = re.findall(r"\bsub +\$0x([0-9a-f]+),%rsp", listing.stdout)
    return max((int(frame, 16) for frame in frames), default=0)


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
            environment = {**os.environ, "OBSCURA_CACHE_DIR": f"{folder}/programs", "POCL_CACHE_DIR": f"{folder}/pocl"}
            self.run_command(*render, env=environment)  # compiles: that needs more stack
            self.run_command(*render, env=environment, preexec_fn=limit_stack)
            kernels = list(pathlib.Path(folder).glob("pocl/**/*.so"))
            self.assertGreaterEqual(len(kernels), 7)
            for kernel in kernels:
                self.assertLess(largest_frame(kernel), STACK // 2, kernel.name)
        self.run_command("check", SCENE, *size)
        self.run_command("check", SCENE, *size, preexec_fn=limit_stack)


if __name__ == "__main__":
    unittest.main()
