#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura check --ray`: one ray in the file's coordinates, wherever the file puts the scene; and scenes with a camera, a
# light or a ray so far away that Embree would abort.
import json
import os
import pathlib
import re
import shlex
import shutil
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
        for ray in ("", "1,2,3", "0,0,0,0,0,0,1", "0,0,0,0,0,1,1,1", "0,0,0,0,0,1,1,1,1,1,1", "a,0,0,0,0,1,1", "0,0,0,0,0,1,nan",
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

    def planted(self, file, text, replacement):
        """The environment of a run whose kernels hold this error."""
        kernels = self.folder / "kernels"
        shutil.copytree(ROOT / "kernels", kernels, dirs_exist_ok=True)
        source = (kernels / file).read_text()
        self.assertEqual(1, source.count(text))
        (kernels / file).write_text(source.replace(text, replacement))
        return {"OBSCURA_KERNEL_DIR": str(kernels), "OBSCURA_CACHE_DIR": str(self.folder)}

    def wrong_rays(self, *arguments, **environment):
        """(queue or case, the device's answer, the expected one, [--case=,] --ray=) of each line."""
        result = self.run_command("check", *arguments, **environment)
        self.assertEqual(1, result.returncode, result.stderr)
        wrong = re.findall(r"^(.*?): device (.*); expected (.*)\n +(.*--ray=.*)$", result.stdout, re.MULTILINE)
        # Beside wrong rays there are those in doubt, as "camera, a tie".
        return [(place, device, expected, shlex.split(line)) for place, device, expected, line in wrong
                if not re.search(", (a tie|at an edge)$", place)]

    def test_lines_of_wrong_hits_are_the_same_rays_again(self):
        environment = self.planted("lib/wide_intersect.clh", "d->t = ((eu", "d->t = 1.00001f * ((eu")
        for transform in ({"translation": [1e6, -3e5, 2e6]}, {"scale": [2**-60] * 3}):
            with self.subTest(transform):
                scene = self.placed(**transform)
                wrong = [line for line in self.wrong_rays(scene, *SMALL, **environment) if line[1].startswith("triangle")]
                self.assertGreater(len(wrong), 4)
                for _, device, expected, ray in wrong[::3]:
                    again = self.run_command("check", scene, *ray, **environment)
                    self.assertEqual(1, again.returncode, again.stderr)
                    self.assertIn(f"device   {device}\n", again.stdout)
                    self.assertIn(f"oracle   {expected}\n", again.stdout)

    def test_lines_of_wrong_results_are_the_same_rays_again(self):
        for queue, file, text, replacement in (
                ("obscurance", "lib/obscurance_result.clh", "= frame->obscurance.y;", "= 1.001f * frame->obscurance.y;"),
                ("obscurance", "lib/obscurance_ray.clh", "(t + along) * (t + along) + across2", "1.001f * (t * t)"),
                ("shadow", "lib/queued_rays.clh", "direction.xyz, direction.w);", "direction.xyz, 0.5f * direction.w);")):
            environment = self.planted(file, text, replacement)
            for transform in ({}, {"translation": [1e6, -3e5, 2e6]}):
                with self.subTest(replacement, **transform):
                    scene = self.placed(**transform)
                    wrong = self.wrong_rays(scene, *SMALL, **environment)
                    self.assertGreater(len(wrong), 2)
                    self.assertEqual({queue}, {line[0] for line in wrong})
                    for _, device, expected, ray in wrong[::4]:
                        again = self.run_command("check", scene, *ray, **environment)
                        self.assertEqual(1, again.returncode, again.stdout + again.stderr)
                        self.assertIn(f"device   {device}\nexpected {expected}\nverdict  device wrong\n", again.stdout)
                    healthy = self.run_command("check", scene, *wrong[0][3])
                    self.assertEqual(0, healthy.returncode, healthy.stdout + healthy.stderr)
                    self.assertIn(f"\nexpected {expected}\n", self.run_command("check", scene, *ray).stdout)

    def test_lines_of_the_self_test_are_the_same_rays_again(self):
        environment = self.planted("lib/wide_intersect.clh", "d->u = ev * inv_det", "d->u = ew * inv_det")
        for cases in ("soup, edges", "room, obscurance"):
            wrong = self.wrong_rays("--self-test", "--case", cases, **environment)
            self.assertGreater(len(wrong), 4)
            for _, device, expected, line in wrong[::5]:
                again = self.run_command("check", "--self-test", *line, **environment)
                self.assertEqual(1, again.returncode, again.stdout + again.stderr)
                self.assertIn(f"device   {device}\n", again.stdout)
                self.assertRegex(again.stdout, f"(oracle  |expected) {re.escape(expected)}\n")
        ray = "0,0,0,0,0,1,1"
        self.expect_refusal("check", "--self-test", "--ray", ray, names="--case")
        self.expect_refusal("check", "--self-test", "--case", "soup", "--ray", ray, names="whole name")
        self.expect_refusal("check", "--self-test", "--case", "soup, edges", "--ray", f"{ray},0,0.001,0", names="ten numbers")

    def test_wrong_any_hit_is_the_same_again(self):
        environment = self.planted("lib/stream_leaf.clh", "stream->hit[ray] = hit_lane(hit);", "if (!any_hit) stream->hit[ray] = hit_lane(hit);")
        _, device, _, line = self.wrong_rays("--self-test", "--case", "triangle soup", **environment)[0]
        self.assertEqual("free", device)
        again = self.run_command("check", "--self-test", *line, **environment)
        self.assertEqual(1, again.returncode, again.stdout + again.stderr)
        self.assertIn("but      any-hit is free: device wrong\n", again.stdout)
        step = ("--bleeding", "off", "--rho", "step", "--no-direct")
        _, device, expected, line = self.wrong_rays(CORNELL, *SMALL, *step, **environment)[0]
        again = self.run_command("check", CORNELL, *line, *step, **environment)
        self.assertIn(f"device   {device}\nexpected {expected}\nverdict  device wrong\n", again.stdout)

    # What no stage traces says nothing about the device.
    def test_other_rays_than_the_stages_have_no_result(self):
        ray = "2.78,2.73,2.8,0,-1,0"
        for reach, has_light in (("1", True), ("inf", True), ("1.5", False)):
            result = self.run_command("check", CORNELL, "--ray", f"{ray},{reach}")
            self.assertEqual(0, result.returncode, result.stdout + result.stderr)
            self.assertEqual(has_light, "Light that comes through" in result.stdout)

    def test_obscurance_ray_has_the_reach_of_the_render(self):
        ray = "2.78,2.73,2.8,0,-1,0"
        start = "0,-0.001,0"
        result = self.run_command("check", CORNELL, "--ray", f"{ray},0.999,{start}", "--dmax", "1")
        self.assertEqual(0, result.returncode, result.stdout + result.stderr)
        self.assertIn("What it brings back", result.stdout)
        for reach in ("inf", "0.99"):
            self.expect_refusal("check", CORNELL, "--ray", f"{ray},{reach},{start}", "--dmax", "1", names="reaches 0.999")
        self.expect_refusal("check", CORNELL, "--ray", f"{ray},0.999,{start}", "--dmax", "1", "--no-obscurance", names="--ray")

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
