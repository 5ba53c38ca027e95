#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Wrong usage: exit code 2, and a message that names what is wrong and what would be right.
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]


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
