#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Every option of `obscura render` changes something. Each is tried against a base render of a small room that
# has what the options act on: an area light and a point light, coloured walls, rough metal, varnish, a mirror,
# two cameras. An option that the help names and this file doesn't is a failure.
import base64
import json
import os
import pathlib
import re
import struct
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
# All features are compiled in, so that options change values and not programs: one compilation for all cases.
BASE = {"--width": "24", "--height": "18", "--spp": "4", "--obscurance-rays": "2", "--needs": "all"}

# Spellings of one option -> arguments that change the picture. Empty lists are covered by a test of their own.
CHANGES_PICTURE = {
    "--spp --samples-per-pixel": ["--spp", "5"],
    "--obscurance-rays --ao-samples": ["--obscurance-rays", "3"],
    "--rho --falloff": ["--rho", "sqrt"],
    "--dmax --ao-distance": ["--dmax", "50%"],
    "--ambient": ["--ambient", "constant"],
    "--bleeding": ["--bleeding", "off"],
    "--no-direct": ["--no-direct"],
    "--no-specular": ["--no-specular"],
    "--no-obscurance": ["--no-obscurance"],
    "--light-samples": ["--light-samples", "2"],
    "--roulette": ["--roulette", "off"],
    "--filter": ["--filter", "gauss"],
    "--background": ["--background", "1,2,3"],
    "--ambient-light": ["--ambient-light", "1,2,3"],
    "--ambient-scale": ["--ambient-scale", "2"],
    "--max-depth": ["--max-depth", "1"],
    "--seed": ["--seed", "1"],
    "--sampler": ["--sampler", "random"],
    "--camera": ["--camera", "side"],
    "--exr-half": ["--exr-half"],
}
# What the header calls them, where merge stumbles first; precision (--exr-half) is no part of the header.
ATTRIBUTES = {
    "--spp --samples-per-pixel": "plannedSamplesPerPixel",
    "--obscurance-rays --ao-samples": "obscuranceRays",
    "--rho --falloff": "falloff",
    "--dmax --ao-distance": "maxDistance",
    "--ambient": "ambient",
    "--bleeding": "ambientIntensity",
    "--no-direct": "direct",
    "--no-specular": "specular",
    "--no-obscurance": "obscurance",
    "--light-samples": "lightSamples",
    "--roulette": "roulette",
    "--filter": "filter",
    "--background": "background",
    "--ambient-light": "ambientIntensity",
    "--ambient-scale": "ambientIntensity",
    "--max-depth": "maxDepth",
    "--seed": "seed",
    "--sampler": "sampler",
    "--camera": "camera",
}
# Neither infinite, nor not a number, nor beyond what can be worked with.
REFUSED = [
    ["--ambient-scale", "nan"], ["--ambient-scale", "inf"], ["--background", "nan,0,0"], ["--ambient-light", "0,inf,0"],
    ["--cropwindow", "nan,1,0,1"], ["--dmax", "nan"], ["--rho", "exp:nan"], ["--memory", "nan"], ["--memory", "inf"],
    ["--preview", "x.png", "--exposure", "nan"], ["--preview", "x.png", "--exposure", "1000"], ["--exposure", "1"],
    ["--spp", "1048576", "--obscurance-rays", "4096"], ["--spp", "1048576", "--light-samples", "4096"],
    ["--width", "nan"], ["--seed", "nan"],
]
# These change how the picture is made, not the picture.
KEEPS_PICTURE = {
    "--memory": ["--memory", "256K"],
    "--wave-size": ["--wave-size", "64"],
    "--local-size": ["--local-size", "32"],
    "--portable-kernels": ["--portable-kernels"],
    "--needs": ["--needs", "auto"],
}
# Each has its own test below.
OTHERS = {
    "--width", "--height", "--cropwindow", "--layers", "--preview", "--exposure", "--stats", "--quiet", "--device",
    "--output --outfile", "--exr-names", "--trace", "--profile", "--heatmap",
}


def write_room(path):
    """A room of 4 x 3 x 4 m, open towards the camera; y is up."""
    quads = [  # material, corner, edge, edge: the normal is edge x edge
        (0, (-2, 0, -2), (0, 0, 4), (4, 0, 0)),  # floor
        (0, (-2, 3, -2), (4, 0, 0), (0, 0, 4)),  # ceiling
        (1, (-2, 0, -2), (0, 3, 0), (0, 0, 4)),  # left wall, red
        (5, (2, 0, -2), (0, 0, 4), (0, 3, 0)),  # right wall, varnished: a weak reflection
        (3, (-2, 0, -2), (4, 0, 0), (0, 3, 0)),  # back wall: a mirror
        (2, (-1, 0.2, -1), (0.3, 0, 1), (1, 0.6, 0)),  # a rough metal sheet above the floor
        (4, (-0.5, 2.9, -0.5), (1, 0, 0), (0, 0, 1)),  # lamp
    ]
    positions = b""
    for _, corner, a, b in quads:
        points = [corner, *(tuple(map(sum, zip(corner, edge))) for edge in (a, b)), tuple(map(sum, zip(corner, a, b)))]
        positions += b"".join(struct.pack("<3f", *points[i]) for i in (0, 1, 3, 0, 3, 2))
    matte = {"KHR_materials_specular": {"specularFactor": 0}}

    def material(color, metallic, roughness, **more):
        pbr = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
        return {"pbrMetallicRoughness": pbr, "doubleSided": True, **more}

    perspective = {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}
    gltf = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_specular"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 20}]}},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(quads) + 3))}],
        "nodes": [{"mesh": i} for i in range(len(quads))] + [
            {"camera": 0, "name": "front", "translation": [0, 1.5, 5]},
            {"camera": 1, "name": "side", "translation": [0.5, 1.2, 5]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 0]},
        ],
        "cameras": [{"name": "front", **perspective}, {"name": "side", **perspective}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": i}, "material": quad[0]}]} for i, quad in enumerate(quads)],
        "materials": [
            material((0.7, 0.7, 0.7), 0, 1, extensions=matte),
            material((0.8, 0.1, 0.1), 0, 1, extensions=matte),
            material((0.9, 0.7, 0.3), 1, 0.4),
            material((0.9, 0.9, 0.9), 1, 0),
            material((0, 0, 0), 0, 1, extensions=matte, emissiveFactor=[1, 1, 1]),
            material((0.2, 0.3, 0.7), 0, 0.3),
        ],
        "accessors": [], "bufferViews": [],
        "buffers": [{"byteLength": len(positions),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(positions).decode()}],
    }
    for i in range(len(quads)):
        points = list(struct.iter_unpack("<3f", positions[72 * i : 72 * i + 72]))
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": 72 * i, "byteLength": 72})
        gltf["accessors"].append({"bufferView": i, "componentType": 5126, "count": 6, "type": "VEC3",
                                  "min": [min(axis) for axis in zip(*points)],
                                  "max": [max(axis) for axis in zip(*points)]})
    path.write_text(json.dumps(gltf), encoding="utf-8")


def obscura(*arguments, cwd=None, **environment):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, cwd=cwd,
                          env={**os.environ, **environment})


class Options(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.scene = cls.folder / "room.gltf"
        write_room(cls.scene)
        cls.base = cls.folder / "base.exr"
        arguments = [word for pair in BASE.items() for word in pair]
        result = obscura("render", cls.scene, "-o", cls.base, "--stats", cls.folder / "base.json", *arguments)
        if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            raise unittest.SkipTest("there is no OpenCL device: " + result.stderr)
        assert result.returncode == 0, result.stderr

    def render(self, name, arguments, replaces=(), **environment):
        """Renders NAME.exr and NAME.json; arguments, and other spellings in replaces, take the base's place."""
        kept = [word for pair in BASE.items() if pair[0] not in (*arguments, *replaces) for word in pair]
        result = obscura("render", self.scene, "-o", self.folder / f"{name}.exr", "--stats",
                         self.folder / f"{name}.json", *kept, *arguments, **environment)
        self.assertEqual(0, result.returncode, result.stderr)
        return result

    def differs(self, name):
        result = obscura("compare", self.folder / f"{name}.exr", self.base)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return result.returncode == 1

    def layers(self, name):
        file = self.folder / f"{name}.exr"
        return sorted(json.loads(obscura("compare", file, file, "--json", "-").stdout)["layers"])

    def stats(self, name):
        return json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))

    def test_every_option_has_a_case(self):
        listed = set()
        for line in obscura("render", "--help").stdout.splitlines():
            match = re.match(r"\s+((?:-\w,)?--[a-z-]+(?:,--[a-z-]+)*)\b", line)
            if match:
                listed.add(" ".join(name for name in match.group(1).split(",") if name.startswith("--")))
        self.assertEqual(listed - {"--help"}, set(CHANGES_PICTURE) | set(KEEPS_PICTURE) | OTHERS)

    def test_same_arguments_give_same_picture(self):
        self.render("again", [])
        self.assertFalse(self.differs("again"))

    def test_number_of_threads_keeps_the_picture(self):
        for count in ("1", "3"):
            with self.subTest(threads=count):
                self.render("threads", [], POCL_MAX_PTHREAD_COUNT=count)
                self.assertFalse(self.differs("threads"))

    def test_options_of_the_picture_change_it(self):
        for spellings, arguments in CHANGES_PICTURE.items():
            with self.subTest(spellings):
                self.render("changed", arguments)
                self.assertTrue(self.differs("changed"), "the picture is the same")
                for alias in set(spellings.split()) - {arguments[0]}:
                    self.render("alias", [alias, *arguments[1:]], replaces=spellings.split())
                    self.assertTrue(self.differs("alias"), f"{alias} doesn't change the picture")

    def test_crops_made_with_different_options_are_not_merged(self):
        self.assertEqual(set(CHANGES_PICTURE) - {"--exr-half"}, set(ATTRIBUTES))
        self.render("left", ["--cropwindow", "0,0.5,0,1"])
        self.render("right", ["--cropwindow", "0.5,1,0,1"])

        def merge():
            return obscura("merge", self.folder / "left.exr", self.folder / "right.exr", "-o", self.folder / "both.exr")

        self.assertEqual(0, merge().returncode)
        for spellings, name in ATTRIBUTES.items():
            with self.subTest(spellings):
                self.render("right", ["--cropwindow", "0.5,1,0,1", *CHANGES_PICTURE[spellings]])
                result = merge()
                self.assertEqual(2, result.returncode, result.stderr)
                self.assertIn(f"right.exr: its {name} is ", result.stderr)

    def test_values_without_sense_are_refused(self):
        for arguments in REFUSED:
            with self.subTest(" ".join(arguments)):
                result = obscura("render", self.scene, "-o", self.folder / "refused.exr", *arguments)
                self.assertEqual(2, result.returncode, result.stderr)
                self.assertIn("--", result.stderr)
                self.assertNotIn("compiling", result.stderr)
                self.assertFalse((self.folder / "refused.exr").exists())

    def test_outputs_must_be_different_files_and_not_the_scene(self):
        scene = self.scene.read_bytes()
        for arguments in (["-o", self.scene], ["-o", "x.exr", "--stats", self.scene], ["-o", "x.exr", "--preview", "./x.exr"]):
            result = obscura("render", self.scene, *arguments, cwd=self.folder)
            self.assertEqual(2, result.returncode, result.stderr)
            self.assertRegex(result.stderr, "it is the (input|same file)")
        self.assertEqual(scene, self.scene.read_bytes())

    def test_options_of_the_work_keep_the_picture_and_change_the_work(self):
        for spellings, arguments in KEEPS_PICTURE.items():
            with self.subTest(spellings):
                self.render("work", arguments)
                self.assertFalse(self.differs("work"), "the picture differs")
        # What each one does change:
        base = self.stats("base")
        for option in ("--wave-size", "--memory"):
            self.render("work", KEEPS_PICTURE[option])
            self.assertLess(self.stats("work")["wave_capacity"], base["wave_capacity"])
        self.render("work", KEEPS_PICTURE["--needs"])
        self.assertLess(len(self.stats("work")["needs"]), len(base["needs"]))

    def test_size_and_crop_change_the_pixels_rendered(self):
        rays = self.stats("base")["rays"]["camera"]
        for arguments, factor in ((["--width", "48"], 2), (["--height", "36"], 2), (["--cropwindow", "0,0.5,0,1"], 0.5)):
            with self.subTest(arguments[0]):
                self.render("size", arguments)
                self.assertEqual(rays * factor, self.stats("size")["rays"]["camera"])

    def test_layers_change_what_is_written(self):
        self.render("all_layers", ["--layers", "all"])
        self.render("no_layers", ["--layers", "none"])
        sizes = [(self.folder / f"{name}.exr").stat().st_size for name in ("no_layers", "base", "all_layers")]
        self.assertEqual(sizes, sorted(set(sizes)))

    def test_beauty_is_a_layer_that_is_there_anyway(self):
        self.render("none", ["--layers", "none"])
        self.render("beauty", ["--layers", "beauty"])
        self.render("beauty_z", ["--layers", "beauty,Z"])
        self.assertEqual(["beauty"], self.layers("none"))
        self.assertEqual(["beauty"], self.layers("beauty"))
        self.assertEqual(["Z", "beauty"], self.layers("beauty_z"))
        self.render("beauty_none", ["--layers", "beauty,none"])
        self.assertEqual(["beauty"], self.layers("beauty_none"))
        self.render("all", ["--layers", "all"])
        self.render("beauty_all", ["--layers", "all,beauty"])
        self.assertEqual(self.layers("all"), self.layers("beauty_all"))
        self.assertGreater(len(self.layers("all")), 10)

    def test_blender_names_change_neither_pixels_nor_preview(self):
        for name in ("plain", "blender"):
            self.render(name, ["--exr-names", name, "--preview", self.folder / f"{name}.png"])
        self.assertFalse(self.differs("plain"))
        result = obscura("compare", self.folder / "blender.exr", self.base, "--layer", "beauty")
        self.assertEqual(0, result.returncode, result.stdout + result.stderr)
        self.assertEqual((self.folder / "plain.png").read_bytes(), (self.folder / "blender.png").read_bytes())

    def test_crops_with_blender_names_are_merged_exactly(self):
        names = ["--exr-names", "blender", "--layers", "all"]
        self.render("whole", [*names, "--preview", self.folder / "whole.png"])
        self.render("upper", [*names, "--cropwindow", "0,1,0,0.4"])
        self.render("lower", [*names, "--cropwindow", "0,1,0.4,1"])
        merged = obscura("merge", self.folder / "upper.exr", self.folder / "lower.exr", "-o", self.folder / "merged.exr",
                         "--preview", self.folder / "merged.png")
        self.assertEqual(0, merged.returncode, merged.stderr)
        compared = obscura("compare", self.folder / "merged.exr", self.folder / "whole.exr")
        self.assertEqual(0, compared.returncode, compared.stdout + compared.stderr)
        self.assertEqual((self.folder / "whole.png").read_bytes(), (self.folder / "merged.png").read_bytes())

    def test_preview_and_exposure_write_pictures(self):
        self.render("dark", ["--preview", self.folder / "dark.png"])
        self.render("bright", ["--preview", self.folder / "bright.png", "--exposure", "2"])
        self.assertNotEqual((self.folder / "dark.png").read_bytes(), (self.folder / "bright.png").read_bytes())

    def test_quiet_prints_nothing(self):
        self.assertNotEqual("", self.render("loud", []).stderr)
        self.assertEqual("", self.render("quiet", ["--quiet"]).stderr)

    def test_trace_is_written_and_keeps_the_picture(self):  # what is in it: trace_file_test.py
        self.render("traced", ["--trace", self.folder / "trace.json"])
        self.assertFalse(self.differs("traced"))
        names = {event["name"] for event in json.loads((self.folder / "trace.json").read_text())["traceEvents"]}
        self.assertLess(set(self.stats("traced")["kernels"]), names)

    def test_profile_prints_a_row_for_each_stage_and_queue(self):
        printed = self.render("profiled", ["--profile"]).stdout
        self.assertFalse(self.differs("profiled"))
        stats = self.stats("profiled")
        profile = stats["profile"]
        self.assertEqual(set(stats["kernels"]), set(profile["stages"]))
        self.assertAlmostEqual(1, sum(stage["share"] for stage in profile["stages"].values()))
        for name, stage in profile["stages"].items():
            self.assertRegex(printed, rf"(?m)^{name} .* {re.escape(stage['bound'])}$")
            self.assertGreater(stage["bytes"], 0)
            self.assertLessEqual(stage["fill"], 1)
        for name, queue in profile["queues"].items():
            self.assertRegex(printed, rf"(?m)^{name} .* nodes +{queue['nodes_per_ray']:.2f} ")
            self.assertEqual(stats["rays"][name], queue["rays"])
            self.assertEqual([queue["rays"]] * 3, [sum(counts) for counts in queue["histograms"].values()])
        self.assertEqual({"camera", "shadow", "glossy", "obscurance"}, set(profile["queues"]))

    def test_profile_leaves_standard_output_to_the_statistics(self):
        result = obscura("render", self.scene, "-o", self.folder / "profiled.exr", "--profile", "--stats", "-", "--needs", "all",
                         "--width", "8", "--height", "6", "--spp", "1")
        self.assertIn("profile", json.loads(result.stdout))

    def test_heat_map_is_a_picture_and_a_layer(self):
        heat = self.folder / "heat.png"
        messages = self.render("heat", ["--heatmap", heat]).stderr
        self.assertRegex(messages, r"heat.png: from black for 0 to pale yellow for \d+ nodes per sample; the most are \d+")
        self.assertEqual([*self.layers("base"), "visits"], self.layers("heat"))
        width, height = struct.unpack(">2I", heat.read_bytes()[16:24])
        self.assertEqual(24, width)
        self.assertGreater(height, 18)  # the colours' scale is below the picture
        self.render("blender", ["--heatmap", heat, "--exr-names", "blender"])
        self.assertIn("ViewLayer.Visits", self.layers("blender"))

    def test_unknown_device_is_refused(self):
        result = obscura("render", self.scene, "-o", self.folder / "x.exr", "--device", "no such device")
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertFalse((self.folder / "x.exr").exists())


if __name__ == "__main__":
    unittest.main()
