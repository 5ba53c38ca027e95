#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# tools/report needs: every feature of the kernels is priced, and a copy of the kernels without one lacks just that. The
# figures themselves take half an hour; here the program is a stand-in.
import json
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
import price_needs  # noqa: E402

# Compiles for a second per feature; renders in 2 ms, twice as long with every feature; the cache holds one KiB.
PROGRAM = """#!/usr/bin/python3 -S
import json, os, pathlib, re, sys
if sys.argv[1] == "info":
    print(json.dumps({"needs": ["bleeding"]}))
    sys.exit()
features = pathlib.Path(os.environ.get("OBSCURA_KERNEL_DIR", "none")) / "lib/features.clh"
off = re.findall("#define NEED_(\\\\w+) 0\\n#ifndef", features.read_text()) if features.exists() else []
cache = pathlib.Path(os.environ["OBSCURA_CACHE_DIR"])
cache.mkdir(exist_ok=True)
(cache / "program").write_bytes(bytes(1024 - 256 * len(off)))
ms = (4 if "all" in sys.argv else 2) - len(off)
print(json.dumps({"seconds": {"compile": 15.0 - len(off)}, "kernels": {"shade": {"ms": ms, "items": 1000}}}))
"""


class PriceNeeds(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_flags_are_those_of_the_needs(self):
        header = (ROOT / "host/scene/needs.h").read_text(encoding="utf-8")
        listed = [line.split()[1] for line in header.splitlines() if line.startswith("    bool ") and " = false;" in line]
        self.assertEqual([name for name in listed if name != "needed"], price_needs.flags())

    def test_a_copy_lacks_one_feature(self):
        copy = price_needs.kernels_without("bleeding", self.folder)
        source = '#include "lib/features.clh"\nNEED_BLEEDING NEED_TEXTURES\n'
        done = subprocess.run(["cpp", "-P", f"-I{copy}", "-DNEED_BLEEDING=1", "-DNEED_TEXTURES=1"], input=source,
                              capture_output=True, text=True, check=True)
        self.assertEqual("0 1", done.stdout.strip())

    def test_tables_hold_every_feature_with_its_price(self):
        program = self.folder / "obscura"
        program.write_text(PROGRAM)
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        done = subprocess.run([ROOT / "tools/report", "needs", "--program", program, "--repeats", "1", "--out", self.folder / "out"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stderr)
        prices = json.loads((self.folder / "out/needs.json").read_text())
        self.assertEqual(2 * len(price_needs.flags()), len(prices["flags"]))
        text = (self.folder / "out/needs.md").read_text()
        # What the scene needs is taken from 2 ms, the rest from 4 ms with every feature.
        self.assertIn("| cornell | bleeding | yes | +1.00 | +0 | +100.0 | 1000 to 2000 | – to – |", text)
        self.assertIn("| kitchen | textures | no | +1.00 | +0 | +33.3 | 3000 to 4000 | – to – |", text)
        self.assertIn("| sphere | +0.00 | +0 | +100.0 | 2000 to 4000 | – to – |", text)
        self.assertEqual(768, prices["flags"][0]["base"]["bytes"])
        self.assertEqual(1024, prices["flags"][0]["other"]["bytes"])

    def test_missing_program_is_told(self):
        done = subprocess.run([ROOT / "tools/report", "needs", "--program", self.folder / "none"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(1, done.returncode)
        self.assertIn("run tools/demo first", done.stderr)


if __name__ == "__main__":
    unittest.main()
