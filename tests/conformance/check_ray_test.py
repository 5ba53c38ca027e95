#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura check --ray`: one ray in the file's coordinates, wherever the file puts the scene; and scenes with a camera, a
# light or a ray so far away that Embree would abort.
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
CORNELL = ROOT / "scenes/cornell/cornell.gltf"
SMALL = ("--width", "32", "--height", "32", "--spp", "1")
# From the middle of the box 2.73 m down to the floor.
DOWN = (2.78, 2.73, 2.8)


class CheckRay(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_command(self, *arguments, **environment):
        result = subprocess.run([PROGRAM, *arguments, "--quiet"], capture_output=True, text=True, check=False,
                                env={**os.environ, **environment})
        if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
            self.skipTest("there is no OpenCL device: " + result.stderr)
        return result

    def expect_refusal(self, *arguments, names):
        result = self.run_command(*arguments)
        self.assertEqual(2, result.returncode, result.stderr)
        self.assertIn(names, result.stderr)

    def cornell(self, change):
        """The Cornell box with a change to its document."""
        document = json.loads(CORNELL.read_text())
        change(document)
        path = self.folder / "scene.gltf"
        path.write_text(json.dumps(document))
        return path

    def placed(self, **transform):
        """The Cornell box under a node with this transform."""

        def place(document):
            scene = document["scenes"][0]
            document["nodes"].append({**transform, "children": scene["nodes"]})
            scene["nodes"] = [len(document["nodes"]) - 1]

        return self.cornell(place)

    def test_one_ray_is_replayed(self):
        for ray, verdict in (("0.1,1,0.1,0,-1,0,inf", "verdict  the same"), ("0.1,1,0.1,0,1,0,0.001", "device   no hit")):
            result = self.run_command("check", CORNELL, "--ray", ray)
            self.assertEqual(0, result.returncode, result.stderr)
            self.assertIn(verdict, result.stdout)

    def test_wrong_rays_are_refused(self):
        for ray in ("", "1,2,3", "0,0,0,0,0,0,1", "0,0,0,0,0,1,1,1", "a,0,0,0,0,1,1", "0,0,0,0,0,1,nan",
                    "3e18,0,0,0,0,1,1", "0,0,0,0,0,3e18,1", "0,0,0,0,0,1e-38,inf", "0,1e30,0,0,0,1,1"):
            with self.subTest(ray):
                self.expect_refusal("check", CORNELL, "--ray", ray, names="--ray")
        self.expect_refusal("check", CORNELL, "--ray", "0,0,0,0,0,1,1", "--json", "-", names="--json")

    def test_coordinates_are_the_files(self):
        for transform, ray, distance in (({}, DOWN, 2.73),
                                         ({"translation": [1e6, 0, 0]}, (1e6 + DOWN[0], *DOWN[1:]), 2.73),
                                         ({"scale": [2**-60] * 3}, [x * 2**-60 for x in DOWN], 2.73 * 2**-60),
                                         ({"scale": [2**40] * 3}, [x * 2**40 for x in DOWN], 2.73 * 2**40)):
            with self.subTest(transform):
                numbers = ",".join(map(repr, ray))
                result = self.run_command("check", self.placed(**transform), f"--ray={numbers},0,-1,0,inf")
                self.assertEqual(0, result.returncode, result.stderr)
                self.assertIn("verdict  the same", result.stdout)
                found = re.findall(r"^(device|Embree|oracle) +triangle \d+ at ([-+.e\d]+)", result.stdout, re.MULTILINE)
                self.assertEqual(["device", "Embree", "oracle"], [name for name, _ in found], result.stdout)
                for _, text in found:
                    self.assertAlmostEqual(1, float(text) / distance, delta=1e-6)

    def test_lines_of_wrong_rays_are_the_same_rays_again(self):
        kernels = self.folder / "kernels"
        subprocess.run(["cp", "-r", ROOT / "kernels", kernels], check=True)
        planted = kernels / "lib/intersect.clh"
        source = planted.read_text()
        self.assertEqual(1, source.count("hit->t = ts[lane];"))
        planted.write_text(source.replace("hit->t = ts[lane];", "hit->t = 1.00001f * ts[lane];"))
        environment = {"OBSCURA_KERNEL_DIR": str(kernels), "OBSCURA_CACHE_DIR": str(self.folder)}
        for transform in ({"translation": [1e6, -3e5, 2e6]}, {"scale": [2**-60] * 3}):
            with self.subTest(transform):
                scene = self.placed(**transform)
                result = self.run_command("check", scene, *SMALL, **environment)
                self.assertEqual(1, result.returncode, result.stderr)
                wrong = re.findall(r": device (triangle .*); expected (.*)\n +(--ray=\S+)", result.stdout)
                self.assertGreater(len(wrong), 8)
                for device, expected, ray in wrong[::5]:
                    again = self.run_command("check", scene, ray, **environment)
                    self.assertEqual(1, again.returncode, again.stderr)
                    self.assertIn(f"device   {device}\n", again.stdout)
                    self.assertIn(f"oracle   {expected}\n", again.stdout)

    def test_far_camera_is_refused(self):
        def move(document):
            document["nodes"][-1]["translation"] = [2.78, 2.73, -1e19]

        scene = self.cornell(move)
        self.expect_refusal("check", scene, *SMALL, names="camera")
        self.expect_refusal("reference", scene, *SMALL, "--sets", "1", "-o", self.folder / "x.exr", names="camera")

    def test_far_light_is_refused_or_traced(self):
        def add(document):
            document["extensionsUsed"].append("KHR_lights_punctual")
            document["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 1e38}]}}
            document["nodes"].append({"translation": [2.78, 2.73, -1e19], "extensions": {"KHR_lights_punctual": {"light": 0}}})
            document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)

        scene = self.cornell(add)
        self.expect_refusal("check", scene, *SMALL, names="light")
        result = self.run_command("reference", scene, *SMALL, "--sets", "1", "-o", self.folder / "x.exr")
        self.assertEqual(0, result.returncode, result.stderr)

    def test_scene_without_triangles_says_so(self):
        def clear(document):
            for node in document["nodes"]:
                node.pop("mesh", None)

        result = self.run_command("check", self.cornell(clear), *SMALL)
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("Nothing was checked: the scene holds no triangles.", result.stdout)
        self.assertNotIn("No hit is wrong", result.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
