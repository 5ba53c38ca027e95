#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Kernel tests, the self-test and small renders on Oclgrind, which interprets kernels and watches every access: no data
# race, no use of uninitialised memory, nothing out of bounds, no misuse of the API.
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ["OBSCURA_PROGRAM"])
WORKAROUNDS = pathlib.Path(os.environ["OCLGRIND_WORKAROUNDS"])
RENDER = ["--width", "16", "--height", "16", "--spp", "1", "--obscurance-rays", "2", "--quiet"]
SELF_TEST = ["triangle soup", "nested scales", "one triangle", "no triangle"]

# Left out of the kernel tests: those of millions of items, which would take hours, and one of the text of a
# compiler's error, as Oclgrind's compiler names its own file and line whatever #line says.
LEFT_OUT = [
    "SamplerOnDevice.PixelsAreIndependent",
    "SamplerOnDevice.CosineDirectionsAreUnitVectorsAboveTheHorizon",
    "SurfaceStage.RaysThatLeaveATriangleDoNotHitItAgain",
    "SurfaceStage.SliversAreLiftedNoHigherThanOtherTriangles",
    "ProgramLibraryOnDevice.BuildErrorNamesStageFileAndLine",
]
# Programs that call the API wrongly on purpose.
MISUSING = ["buffer_test", "program_library_test"]

# What goes wrong, the file, its text, what replaces that, and what Oclgrind calls it.
MUTANTS = [
    ("points share their results", "obscurance.cl", "results + (size_t)point.slot * k_count;", "results;", "data race"),
    ("a miss has no weights", "lib/traverse.clh", "    hit.u = 0.0f;\n", "", "Uninitialized value"),
    ("results lie behind their buffer", "obscurance.cl", "results + (size_t)point.slot * k_count;",
     "results + (size_t)(point.slot + frame->crop.w) * k_count;", "Invalid write"),
]


def runtime():
    """Oclgrind's OpenCL library, which takes the loader's place; None where it isn't installed."""
    program = shutil.which("oclgrind")
    library = pathlib.Path(program).resolve().parents[1] / "lib/oclgrind/liboclgrind-rt.so" if program else None
    return library if library and library.exists() else None


def run(command, folder, check_api=True, **environment):
    """The finished process and what Oclgrind found. Optimised vector code would be reported for moving whole vectors
    of which only some elements are set (-cl-opt-disable)."""
    log = pathlib.Path(folder) / "oclgrind.log"
    checks = ["DATA_RACES", "UNINITIALIZED"] + (["CHECK_API"] if check_api else [])
    oclgrind = {f"OCLGRIND_{check}": "1" for check in checks}
    oclgrind.update(OCLGRIND_BUILD_OPTIONS="-cl-opt-disable", OCLGRIND_LOG=str(log), OCLGRIND_MAX_ERRORS="20")
    oclgrind.update(LD_PRELOAD=f"{WORKAROUNDS} {runtime()}", OBSCURA_DEVICE="Oclgrind", OBSCURA_CACHE_DIR=str(folder))
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                          env={**os.environ, **oclgrind, **environment})
    return done, log.read_text(errors="replace") if log.exists() else ""


class Oclgrind(unittest.TestCase):
    def setUp(self):
        if runtime() is None:
            if os.environ.get("OBSCURA_REQUIRE_DEVICE") == "1":
                self.fail("Oclgrind is not installed (tools/deps devices)")
            self.skipTest("Oclgrind is not installed (tools/deps devices)")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def render(self, scene, **environment):
        return run([PROGRAM, "render", ROOT / "scenes" / scene, "-o", f"{self.folder}/{scene}.exr", *RENDER], self.folder, **environment)

    def assert_clean(self, done, log):
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertEqual("", log.strip())

    def test_small_renders(self):
        for scene in ("cornell", "planes", "wall", "sphere", "furnace"):
            with self.subTest(scene):
                self.assert_clean(*self.render(scene))

    def test_self_test(self):
        for case in SELF_TEST:
            with self.subTest(case):
                self.assert_clean(*run([PROGRAM, "check", "--self-test", "--case", case], self.folder))

    def test_kernel_tests(self):
        names = sorted(path.stem for path in (ROOT / "tests/kernel").glob("*_test.cpp"))
        for name in names:
            with self.subTest(name):
                command = [WORKAROUNDS.parent / name, "--gtest_filter=-" + ":".join(LEFT_OUT)]
                done, log = run(command, self.folder, check_api=name not in MISUSING, OBSCURA_REQUIRE_DEVICE="1")
                self.assert_clean(done, log)

    def test_planted_errors_are_found(self):
        for what, file, text, replacement, finding in MUTANTS:
            with self.subTest(what), tempfile.TemporaryDirectory() as folder:
                shutil.copytree(ROOT / "kernels", folder, dirs_exist_ok=True)
                path = pathlib.Path(folder) / file
                source = path.read_text()
                self.assertEqual(1, source.count(text), text)
                path.write_text(source.replace(text, replacement))
                self.assertIn(finding, self.render("cornell", OBSCURA_KERNEL_DIR=folder)[1])


if __name__ == "__main__":
    unittest.main(verbosity=2)
