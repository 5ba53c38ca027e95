#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# tools/price-remedies: each remedy's text stands in the kernels, and the copy without it lacks just that; its worth is what
# obscura check and obscura compare tell. The prices themselves take a quarter of an hour; here the program is a stand-in.
import argparse
import importlib.machinery
import pathlib
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))  # where the script finds the module beside it
loader = importlib.machinery.SourceFileLoader("price_remedies", str(ROOT / "tools/price-remedies"))
price_remedies = types.ModuleType("price_remedies")
price_remedies.__file__ = loader.path
loader.exec_module(price_remedies)

# Renders 1000 items of each stage in 2 ms, in 1 ms without a remedy, which leaves 3 rays wrong and the picture 0.1 off.
STAND_IN = """#!/usr/bin/env python3
import json, os, pathlib, sys
whole = pathlib.Path(os.environ["OBSCURA_KERNEL_DIR"]) == pathlib.Path({kernels!r})
if sys.argv[1] == "render":
    row = {{"ms": 2 if whole else 1, "items": 1000}}
    print(json.dumps({{"kernels": dict.fromkeys({stages!r}, row)}}))
elif sys.argv[1] == "check":
    print(json.dumps({{"device_wrong": 0 if whole else 3}}))
    sys.exit(0 if whole else 1)
else:
    print(json.dumps({{"relmse": 0.01}}))
    sys.exit(1)
"""


class PriceRemedies(unittest.TestCase):
    def test_copies_lack_their_remedy(self):
        for remedy in price_remedies.REMEDIES:
            with self.subTest(remedy[0]), tempfile.TemporaryDirectory() as folder:
                without = price_remedies.kernels_without(remedy, folder)
                changed = {str(file.relative_to(without)) for file in without.rglob("*.cl*")
                           if file.read_bytes() != (ROOT / "kernels" / file.relative_to(without)).read_bytes()}
                self.assertEqual({file for file, _, _ in remedy[1]}, changed)

    def test_kernels_of_other_flags_have_caches_of_their_own(self):
        flagged = [remedy for remedy in price_remedies.REMEDIES if len(remedy) > 3]
        self.assertTrue(flagged)
        for remedy in price_remedies.REMEDIES:
            with self.subTest(remedy[0]), tempfile.TemporaryDirectory() as folder:
                environment = price_remedies.without(remedy, folder)
                self.assertEqual(f"{folder}/kernels", environment.pop("OBSCURA_KERNEL_DIR"))
                self.assertEqual(remedy[3] if remedy in flagged else None, environment.pop("POCL_EXTRA_BUILD_FLAGS", None))
                caches = {f"{folder}/cache", f"{folder}/pocl"} if remedy in flagged else set()
                self.assertEqual(caches, set(environment.values()))

    def test_rows_tell_speeds_added_time_and_worth(self):
        stages = [*price_remedies.TRACING, "shade", "film"]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            program = folder / "obscura"
            program.write_text(STAND_IN.format(kernels=str(ROOT / "kernels"), stages=stages))
            program.chmod(0o755)
            options = argparse.Namespace(program=program, repeats=3, scene="scene")
            rows = price_remedies.price(options, price_remedies.REMEDIES[0], folder)
        self.assertEqual(price_remedies.TRACING, [row[1] for row in rows])
        self.assertEqual(["0.50", "1.00", "+100.0", "+100.0", "+100.0", "3", "0.1"], rows[0][2:])


if __name__ == "__main__":
    unittest.main()
