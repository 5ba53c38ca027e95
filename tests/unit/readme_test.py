#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# The README must say what the source says: dependencies as listed, files that exist, options and subcommands as
# the program's own help has them (program: OBSCURA_PROGRAM), environment variables as the source reads them.
import os
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def table(heading):
    """The cells of the first table below a heading, without its head rows and without code marks."""
    section = re.search(rf"^#+ {re.escape(heading)}\n(.*?)(?=^#+ |\Z)", README, re.MULTILINE | re.DOTALL)
    rows = re.findall(r"^\|(.*)\|$", section.group(1), re.MULTILINE)
    return [[cell.strip().replace("`", "") for cell in row.split(" | ")] for row in rows[2:]]


def run_help(*arguments):
    program = os.environ["OBSCURA_PROGRAM"]
    return subprocess.run([program, *arguments, "--help"], capture_output=True, text=True, check=True).stdout


def long_options(text):
    return set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text))


class Readme(unittest.TestCase):
    def test_dependencies_equal_the_package_list(self):
        lines = (ROOT / "tools/packages.txt").read_text(encoding="utf-8").splitlines()
        listed = [line.split(maxsplit=2) for line in lines if line and not line.startswith("#")]
        self.assertEqual(listed, table("Dependencies"))

    def test_linked_files_exist(self):
        links = re.findall(r"\]\((?!#|https?:)([^)]+)\)", README)
        self.assertEqual([], [link for link in links if not (ROOT / link).exists()])

    def test_named_tools_exist(self):
        named = set(re.findall(r"`((?:tools|\.ci)/[a-z_/.-]+)", README))
        self.assertEqual([], [name for name in sorted(named) if not (ROOT / name).exists()])

    def test_environment_variables_equal_those_in_the_source(self):
        in_source = set()
        for folder in ("host", "tests"):
            for file in [*(ROOT / folder).rglob("*.cpp"), *(ROOT / folder).rglob("*.h")]:
                text = file.read_text(encoding="utf-8")
                in_source |= set(re.findall(r'"(OBSCURA_[A-Z_]+)"', text))
        self.assertEqual(sorted(in_source), sorted(row[0] for row in table("Environment variables")))


@unittest.skipUnless("OBSCURA_PROGRAM" in os.environ, "OBSCURA_PROGRAM names no program")
class Program(unittest.TestCase):
    def test_subcommands_are_those_of_the_help(self):
        documented = re.findall(r"^### (\w+):", README, re.MULTILINE)
        listed = re.search(r"^Subcommands:\n((?:  .*\n?)+)", run_help(), re.MULTILINE).group(1)
        self.assertEqual(sorted(re.findall(r"^  (\w+)", listed, re.MULTILINE)), sorted(documented))

    def test_render_options_are_those_of_the_help(self):
        documented = long_options(" ".join(row[0] for row in table("Options of render")))
        self.assertEqual(sorted(long_options(run_help("render")) - {"--help"}), sorted(documented))

    def test_reference_options_are_those_of_the_help(self):
        own = long_options(" ".join(row[0] for row in table("reference: what a picture should be")))
        text = re.search(r"it takes those of render, but for (.*?)\.\s", README, re.DOTALL).group(1)
        shared = long_options(run_help("render")) - long_options(text)
        self.assertEqual(sorted(long_options(run_help("reference"))), sorted(own | shared))

    def test_layers_are_those_of_the_program(self):
        program = os.environ["OBSCURA_PROGRAM"]
        command = [program, "render", str(ROOT / "scenes/cornell"), "-o", os.devnull, "--layers", "nope"]
        refusal = subprocess.run(command, capture_output=True, text=True, check=False).stderr
        listed = re.search(r"choose from (.*), or all, or none", refusal).group(1).split(", ")
        self.assertEqual(sorted(listed), sorted(row[0].replace("(none)", "beauty") for row in table("Layers")))

    def test_examples_use_options_that_exist(self):
        examples = re.findall(r"^(?:[A-Z_]+=\S+ )?build/obscura (\w+)(.*)$", README, re.MULTILINE)
        self.assertGreater(len(examples), 0)
        for subcommand, arguments in examples:
            unknown = long_options(arguments) - long_options(run_help(subcommand))
            self.assertEqual(set(), unknown, f"obscura {subcommand} has no such option")

    def test_every_subcommand_has_an_example(self):
        for subcommand in re.findall(r"^### (\w+):", README, re.MULTILINE):
            self.assertIn(f"\nbuild/obscura {subcommand}", README)


if __name__ == "__main__":
    unittest.main()
