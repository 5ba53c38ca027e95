#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Wrong usage: exit code 2, and a message that names what is wrong and what would be right.
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
CORNELL = pathlib.Path(__file__).resolve().parents[2] / "scenes/cornell"


def run(*arguments, **environment):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})


class Usage(unittest.TestCase):
    def expect_message(self, arguments, message):
        result = run(*arguments)
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertRegex(result.stderr, "^obscura: error: " + message)
        self.assertIn("--help", result.stderr)

    def test_unknown_subcommand_is_named(self):
        self.expect_message(["rendr", "scene"], "rendr is not a subcommand")

    def test_missing_scene_is_named(self):
        self.expect_message(["render"], "scene is required")

    def test_choices_are_listed_as_words(self):
        render = ["render", "scene", "-o", "x.exr"]
        self.expect_message([*render, "--filter", "lanczos"], "--filter: lanczos: choose from bh, box, gauss, tent\n")
        self.expect_message([*render, "--bleeding", "1"], "--bleeding: 1: choose from off, on\n")

    def test_seed_is_a_whole_number_of_64_bits(self):
        for seed in ("-1", "1.5", "inf", "abc", "", "99999999999999999999"):
            self.expect_message(["render", "scene", "-o", "x.exr", "--seed", seed], "--seed: .*is not a whole number")

    def test_numbers_must_be_whole_and_in_range(self):
        for option, value, most in (("--width", "1.5", 65536), ("--spp", "abc", 1 << 24), ("--local-size", "0", 4096)):
            self.expect_message(["render", "scene", "-o", "x.exr", option, value],
                                f"{option}.*: {value} is not a whole number from 1 to {most}\n")

    def test_options_given_twice_are_named(self):
        render = ["render", "scene", "-o", "x.exr"]
        self.expect_message([*render, "--spp", "1", "--spp", "2"], "--spp is given twice\\.\n")
        self.expect_message([*render, "-o", "y.exr", "--outfile", "z.exr"], "--output is given 3 times\\.\n")

    def test_ambient_light_is_not_both_left_out_and_chosen(self):
        for option in (["--ambient-light", "1,1,1"], ["--ambient-scale", "2"]):
            result = run("render", CORNELL, "-o", "x.exr", "--ambient", "none", *option)
            self.assertEqual(2, result.returncode, result.stderr)
            self.assertIn(f"--ambient none leaves nothing to {option[0]}", result.stderr)
            self.expect_message(["render", "scene", "-o", "x.exr", "--no-obscurance", *option],
                                f"({option[0]}|--no-obscurance) excludes")
        self.expect_message(["render", "scene", "-o", "x.exr", "--no-obscurance", "--ambient", "constant"],
                            "--ambient excludes --no-obscurance\n")

    def test_all_and_none_are_no_names_among_others(self):
        for layers in ("all,none", "none,Z"):
            result = run("render", CORNELL, "-o", os.devnull, "--layers", layers)
            self.assertEqual(2, result.returncode, result.stderr)
            self.assertIn(f"--layers {layers}: all and none stand alone", result.stderr)

    def test_unknown_device_is_told_with_its_variable(self):
        result = run("render", CORNELL, "-o", os.devnull, OBSCURA_DEVICE="no such device")
        if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            self.skipTest("there is no OpenCL device: " + result.stderr)
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertIn('variable OBSCURA_DEVICE: No OpenCL device matches "no such device"', result.stderr)

    def test_help_names_what_an_option_takes(self):
        for subcommand, expected in (("compare", ("image X.exr", "--layer NAME", "--heatmap X.png", "--json FILE.json|-")),
                                     ("merge", ("parts X.exr", "--outfile X.exr", "--preview X.png"))):
            text = run(subcommand, "--help").stdout
            for name in expected:
                self.assertIn(name, text)

    def test_empty_names_are_refused(self):
        for option in ("--camera", "--device"):
            self.expect_message(["render", "scene", "-o", "x.exr", option, ""], f"{option}: a name is needed\n")

    def test_empty_variable_names_no_device(self):
        result = run("render", "no/such/scene", "-o", "x.exr", OBSCURA_DEVICE="")
        self.assertIn("no such scene file or folder", result.stderr)

    def test_no_usable_device_is_a_failure(self):
        with tempfile.TemporaryDirectory() as empty:
            result = run("devices", OCL_ICD_VENDORS=empty)
        self.assertEqual(3, result.returncode)
        self.assertIn("can use none", result.stdout)


if __name__ == "__main__":
    unittest.main()
