#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# tools/report needs: every feature of the kernels is priced, and a copy of the kernels without one lacks just that. The
# figures themselves take half an hour; here the program is a stand-in.
import argparse
import contextlib
import importlib.machinery
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
import price_needs  # noqa: E402


def stand_in(command, environment):
    """Renders in 2 ms, twice as long with every feature, a millisecond less if the kernels lack any; then the cache is smaller
    by 256 bytes, too. Compiling takes a second. It needs what FEATURES says that the scene and the options need."""
    features = pathlib.Path(environment.get("OBSCURA_KERNEL_DIR", "none")) / "lib/features.clh"
    lacks = features.exists() and re.search("#define NEED_\\w+ 0\n#ifndef", features.read_text(encoding="utf-8")) is not None
    program = pathlib.Path(environment["OBSCURA_CACHE_DIR"]) / "program"
    cold = not program.exists()
    program.parent.mkdir(exist_ok=True)
    program.write_bytes(bytes(1024 - 256 * lacks))
    scene = command[2].name if command[2].is_dir() else f"cornell + {command[2].stem}"
    needs = [name for name, (yes, no) in price_needs.FEATURES.items() if yes == (scene, []) and not set(no[1]) & set(command)]
    ms = (4.0 if "all" in command else 2.0) - lacks
    stats = {"needs": needs, "device": "a device", "driver": "1", "kernels": {"shade": {"ms": ms, "items": 1000}}}
    return stats, ms + cold


def variant(seconds, **stages):
    return type("Stand-in", (), {"cost": {"compile_cpu_seconds": 1.0, "bytes": 1024}, "times": lambda _: {"cpu": seconds, **stages}})()


class PriceNeeds(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_flags_are_those_of_the_needs(self):
        header = (ROOT / "host/scene/needs.h").read_text(encoding="utf-8")
        listed = [line.split()[1] for line in header.splitlines() if line.startswith("    bool ") and " = false;" in line]
        self.assertEqual([name for name in listed if name != "needed"], price_needs.flags())
        self.assertEqual(price_needs.flags(), list(price_needs.FEATURES))

    def test_a_copy_lacks_what_is_named(self):
        copy = price_needs.kernels_without(["bleeding", "glossy"], self.folder)
        source = '#include "lib/features.clh"\nNEED_BLEEDING NEED_GLOSSY NEED_TEXTURES\n'
        done = subprocess.run(["cpp", "-P", f"-I{copy}", "-DNEED_BLEEDING=1", "-DNEED_GLOSSY=1", "-DNEED_TEXTURES=1"], input=source,
                              capture_output=True, text=True, check=True)
        self.assertEqual("0 0 1", done.stdout.strip())

    def test_intervals_of_the_median(self):
        self.assertEqual([3, 1, 5], price_needs.median_with_interval([5, 3, 1, 4, 2]))
        self.assertEqual([8, 3, 13], price_needs.median_with_interval(range(1, 16)))

    def test_times_are_those_of_stages_that_have_items(self):
        pricer = price_needs.Pricer("none", 3, self.folder)
        row = pricer.compare(variant(100, shade=50, shadow=7), variant(110, shade=60, gather=9))
        self.assertEqual(["+0.0", "+0", "+10.0 (+10.0 to +10.0)", "50 to 60", "7 to –", "–", "– to 9"], price_needs.cells(row))

    def test_tables_hold_every_feature_with_its_price(self):
        program = self.folder / "obscura"
        program.touch()
        loader = importlib.machinery.SourceFileLoader("report", str(ROOT / "tools/report"))
        report = types.ModuleType("report")
        report.__file__ = loader.path
        loader.exec_module(report)
        options = argparse.Namespace(program=program, repeats=1, out=self.folder / "out")
        with unittest.mock.patch.object(price_needs, "run", stand_in), contextlib.redirect_stdout(io.StringIO()) as printed, \
             contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(0, report.needs(options))
        prices = json.loads((self.folder / "out/needs.json").read_text())
        self.assertEqual([(flag, needed) for flag in price_needs.flags() for needed in (True, False)],
                         [(row["feature"], row["needed"]) for row in prices["flags"]][:-1])
        for row in prices["flags"]:
            self.assertEqual((768, 1024), (row["base"]["bytes"], row["other"]["bytes"]))
            self.assertEqual(1, row["other"]["compile_cpu_seconds"])
        text = (self.folder / "out/needs.md").read_text()
        self.assertEqual(text, printed.getvalue().removesuffix("\n"))
        # What the scene needs is taken from 2 ms, the rest from 4 ms with every feature.
        self.assertIn("| bleeding | yes | cornell | +0.0 | +0 | +100.0 (+100.0 to +100.0) | 1000 to 2000 | – | – | – |", text)
        self.assertIn("| textures | no | cornell | +0.0 | +0 | +33.3 (+33.3 to +33.3) | 3000 to 4000 | – | – | – |", text)
        self.assertIn("| sphere | +0.0 | +0 | +100.0 (+100.0 to +100.0) | 2000 to 4000 | – | – | – |", text)

    def test_missing_program_is_told(self):
        done = subprocess.run([ROOT / "tools/report", "needs", "--program", self.folder / "none"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(1, done.returncode)
        self.assertIn("run tools/demo first", done.stderr)


@unittest.skipUnless("OBSCURA_PROGRAM" in os.environ, "OBSCURA_PROGRAM names no program")
class LitScenes(unittest.TestCase):
    def test_punctual_lights_are_needed(self):
        for kind in ("point", "spot", "directional"):
            with tempfile.TemporaryDirectory() as folder:
                path = price_needs.scene_path(f"cornell + {kind}", folder)
                done = subprocess.run([os.environ["OBSCURA_PROGRAM"], "info", path, "--json", "-"], capture_output=True, text=True,
                                      check=True)
            self.assertIn(f"{kind}_lights", json.loads(done.stdout)["needs"])


if __name__ == "__main__":
    unittest.main()
