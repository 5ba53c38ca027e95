#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Kernel tests, the self-test and small renders on Oclgrind, which interprets kernels and watches every access: no data
# race, no use of uninitialised memory, nothing out of bounds, no misuse of the API.
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ["OBSCURA_PROGRAM"])
WORKAROUNDS = pathlib.Path(os.environ["OCLGRIND_WORKAROUNDS"])
SCENES = ["cornell", "furnace", "kitchen", "planes", "sphere", "wall"]
RENDER = ["--width", "16", "--height", "16", "--spp", "1", "--obscurance-rays", "2", "--quiet"]
# Of a few thousand rays each; a ray takes about a millisecond here. What the other cases ask of the kernels, the
# renders and kernel tests do too.
SELF_TEST = ["triangle soup", "nested scales", "one triangle", "no triangle"]

# Left out of the kernel tests: those that only repeat, up to millions of times, what another does with few items.
LEFT_OUT = [
    "SamplerOnDevice.CosineDirectionsAreUnitVectorsAboveTheHorizon",  # 2.4 million; CosineDirectionsHaveTheirMoments
    "SurfaceStage.RaysThatLeaveATriangleDoNotHitItAgain",  # 1.2 million; TraceStage, NormalsOfSlivers...
    "SurfaceStage.SliversAreLiftedNoHigherThanOtherTriangles",  # 0.6 million; the same two
    "FilmStage.ManySamplesKeepTheirMeanAndVariance",  # 67 million; AddsSlotsOfAFullWave..., DeviationsDontDepend...
    # And two for their texts: Oclgrind's compiler names its own file and line whatever #line says, and counts its
    # warnings whatever -w says.
    "ProgramLibraryOnDevice.BuildErrorNamesStageFileAndLine",
    "ProgramLibraryOnDevice.WarningsOfACompilerAreNotForUsers",
]
# Programs that call the API wrongly on purpose, and what that gives.
MISUSES = {
    "buffer_test": ["CL_INVALID_ARG_SIZE", "CL_INVALID_WORK_ITEM_SIZE"],
    "program_library_test": ["CL_INVALID_BINARY", "CL_INVALID_KERNEL_NAME"],
}

# What goes wrong, the file, its text, what replaces that, and what Oclgrind calls it.
MUTANTS = [
    ("points share their results", "lib/obscurance_ray.clh", "= slot * k_count + first_k", "= first_k", "data race"),
    ("a miss has no weights", "lib/intersect.clh", "    hit.u = 0.0f;\n", "",
     "Uninitialized value"),
    ("results lie behind their buffer", "lib/obscurance_ray.clh", "= slot * k_count + first_k",
     "= (slot + frame->crop.w) * k_count + first_k", "Invalid write"),
]

# On standard error: a misuse of the API with its code, and what obscura says itself.
API_ERROR = r"Oclgrind - OpenCL runtime error detected\n\tFunction: .*\n\tError:    (\w+)\n(?:\t.*\n)*"
OWN_LINE = r"(?:compiling kernel .* m?s|obscura: warning: .*)\n"


def runtime():
    """Oclgrind's OpenCL library, which takes the loader's place; None where it isn't installed."""
    program = shutil.which("oclgrind")
    library = pathlib.Path(program).resolve().parents[1] / "lib/oclgrind/liboclgrind-rt.so" if program else None
    return library if library and library.exists() else None


def run(command, **environment):
    """The finished process, what Oclgrind finds on its standard error. Oclgrind's own log would lack misuse of the API,
    and each context empties it. Optimised vector code would be reported for moving whole vectors of which only some
    elements are set (-cl-opt-disable)."""
    checks = ["DATA_RACES", "UNIFORM_WRITES", "UNINITIALIZED", "CHECK_API"]
    oclgrind = {f"OCLGRIND_{check}": "1" for check in checks}
    oclgrind.update(OCLGRIND_BUILD_OPTIONS="-cl-opt-disable", OCLGRIND_MAX_ERRORS="20")
    oclgrind.update(LD_PRELOAD=f"{WORKAROUNDS} {runtime()}", OBSCURA_DEVICE="Oclgrind", OBSCURA_REQUIRE_DEVICE="1")
    with tempfile.TemporaryDirectory() as cache:
        return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                              env={**os.environ, **oclgrind, "OBSCURA_CACHE_DIR": cache, **environment})


def render(scene, **environment):
    with tempfile.TemporaryDirectory() as folder:
        return run([PROGRAM, "render", ROOT / "scenes" / scene, "-o", f"{folder}/{scene}.exr", *RENDER], **environment)


def self_test(case):
    return run([PROGRAM, "check", "--self-test", "--case", case])


def kernel_test(name):
    return run([WORKAROUNDS.parent / name, "--gtest_filter=-" + ":".join(LEFT_OUT)])


def planted_error(mutant):
    _, file, text, replacement, _ = mutant
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "kernels", folder, dirs_exist_ok=True)
        path = pathlib.Path(folder) / file
        source = path.read_text()
        assert source.count(text) == 1, text
        path.write_text(source.replace(text, replacement))
        return render("cornell", OBSCURA_KERNEL_DIR=folder)


def each(function, items):
    """The items with what the function makes of them, two at a time: Oclgrind runs on one thread."""
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        yield from zip(items, pool.map(function, items))


class Oclgrind(unittest.TestCase):
    def setUp(self):
        if runtime() is None:
            if os.environ.get("OBSCURA_REQUIRE_DEVICE") == "1":
                self.fail("Oclgrind is not installed (tools/deps devices)")
            self.skipTest("Oclgrind is not installed (tools/deps devices)")

    def assert_clean(self, done, misuses=()):
        """Nothing is found but these misuses of the API."""
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertEqual(list(misuses), re.findall(API_ERROR, done.stderr), done.stderr)
        self.assertEqual("", re.sub(f"{API_ERROR}|{OWN_LINE}", "", done.stderr).strip())

    def test_small_renders(self):
        for scene, done in each(render, SCENES):
            with self.subTest(scene):
                self.assert_clean(done)

    def test_self_test(self):
        for case, done in each(self_test, SELF_TEST):
            with self.subTest(case):
                self.assert_clean(done)

    def test_kernel_tests(self):
        names = sorted(path.stem for path in (ROOT / "tests/kernel").glob("*_test.cpp"))
        for name, done in each(kernel_test, names):
            with self.subTest(name):
                self.assert_clean(done, MISUSES.get(name, ()))

    def test_planted_errors_are_found(self):
        for (what, *_, finding), done in each(planted_error, MUTANTS):
            with self.subTest(what):
                self.assertIn(finding, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
