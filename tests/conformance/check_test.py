#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura check`: the kitchen at the paper's settings has no wrong ray, and kernels with an error planted are found out.
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["OBSCURA_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]

# What goes wrong, the cases of the self-test that show it, the file, its text and what replaces that.
MUTANTS = [
    ("the last triangle of each block is dropped", "soup, edges", "lib/stream_leaf.clh", "i < BLOCK_WIDTH && primitives", "i < BLOCK_WIDTH - 1u && primitives"),
    ("the last triangle of each block is dropped for few rays", "triangle soup", "lib/stream_leaf.clh", "wide_block(block + b, &shear, open, origin.w, &d)", "wide_block(block + b, &shear, open, origin.w, &d) & 0x7777u"),
    ("< for <= at edges", "inside, edges", "lib/wide_intersect.clh", "(least >= 0.0f) | (most <= 0.0f)", "(least > 0.0f) | (most < 0.0f)"),
    ("no slab padding", "inside", "lib/intersect.clh", "(1.0f + 2.0f * GAMMA(9))", "1.0f"),
    ("swapped children", "triangle soup", "lib/stream_walk.clh", "stack_child[top] = children[other];", "stack_child[top] = children[nearest];"),
    ("rays that follow another child", "triangle soup", "lib/stream_node.clh", "entries->masks[first / LANES][c],", "entries->masks[first / LANES][c ^ 1u],"),
    ("one ray instead of another that enters a child", "triangle soup", "lib/stream_node.clh", "(bits >> c)", "(bits >> (c ^ 1u))"),
    ("rays given up too early", "triangle soup", "lib/stream_state.clh", "SLAB_PADDING >= start", "SLAB_PADDING >= 1.5f * start"),
    ("the next primitive", "soup, edges", "lib/stream_leaf.clh", "&d, lane, primitives[i], any_hit", "&d, lane, primitives[i] ^ 1u, any_hit"),
    ("rays with another's longest axis", "triangle soup", "lib/stream_leaf.clh", "shear->w == 0.0f", "shear->w == 1.0f"),
    ("rays in other lanes", "triangle soup", "lib/lanes.clh", "list[4u + row]", "list[8u + row]"),
    ("boxes out of reach that are not", "room", "lib/stream_state.clh", "*upper = most + room;", "*upper = most - 0.1f * fabs(most);"),
    ("the next primitive for few rays", "triangle soup", "lib/stream_leaf.clh", "[lane % BLOCK_WIDTH], any_hit", "[lane % BLOCK_WIDTH] ^ 1u, any_hit"),
    ("distances too long by 1e-5", "soup, edges", "lib/stream_leaf.clh", "((const float*)&d->t)[lane]", "1.00001f * ((const float*)&d->t)[lane]"),
    ("weights of other corners", "soup, edges", "lib/stream_leaf.clh", "((const float*)&d->u)[lane]", "((const float*)&d->v)[lane]"),
    ("the last triangle of each block is dropped for single rays", "triangle soup", "lib/intersect.clh", "inside & (det != 0.0f));", "inside & (det != 0.0f)) & 7u;"),
    ("a ray alone in a leaf looks backwards", "triangle soup", "lib/stream_leaf.clh", "s.z = -shear.z;", "s.z = shear.z;"),
    ("d from the offset origin", "room", "lib/obscurance_ray.clh", "(t + along) * (t + along) + across2", "t * t"),
    ("rho for another d_max", "room", "lib/obscurance_result.clh", "= frame->obscurance.y;", "= 1.001f * frame->obscurance.y;"),
    ("rays beyond d_max", "room", "lib/obscurance_ray.clh", "sqrt(square > 0.0f ? square : (FLOAT)(0.0f)) - along", "(FLOAT)(2.0f * d_max)"),
    ("colours from the wrong corner", "room", "lib/obscurance_result.clh", "tables, hit.u, hit.v) * material", "tables, hit.v, hit.u) * material"),
    ("shadow rays that stop half-way", "room", "lib/queued_rays.clh", "direction.xyz, direction.w);", "direction.xyz, 0.5f * direction.w);"),
    ("panes that dim too little", "room", "lib/pane.clh", "(1.0f - pane_reflectance(cosine))", "(1.0f - 0.99f * pane_reflectance(cosine))"),
]


def check(*arguments, environment=None):
    """Exit code and numbers of a check."""
    result = subprocess.run([PROGRAM, "check", *arguments, "--quiet", "--json", "-"], capture_output=True, text=True, check=False,
                            env={**os.environ, **(environment or {})})
    if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
        raise unittest.SkipTest("there is no OpenCL device: " + result.stderr)
    if result.returncode not in (0, 1):
        raise AssertionError(result.stderr)
    return result.returncode, json.loads(result.stdout)


class Check(unittest.TestCase):
    def test_kitchen_has_no_wrong_ray(self):
        code, numbers = check(ROOT / "scenes/kitchen")
        for name, queue in numbers["queues"].items():
            with self.subTest(queue=name):
                self.assertEqual(0, queue["device_wrong"], queue["disagreements"])
                self.assertGreater(queue["rays"], 10**6)
                self.assertLess(queue["distance_error_of_bound"], 1)
                self.assertLess(queue["weight_error_of_bound"], 1)
        for name in ("shadow", "obscurance"):
            results = numbers["queues"][name]["results"]
            self.assertLess(results["error_of_bound"], 1)
            self.assertGreater(results["checked"], 0.99 * numbers["queues"][name]["rays"])
            self.assertGreater(results["behind_panes"], 1000)
        self.assertEqual(800 * 600 * 8, numbers["queues"]["camera"]["rays"])
        self.assertEqual(numbers["rendered_rays"], numbers["rays"])
        self.assertEqual(0, code)

    def test_scene_or_self_test_not_both(self):
        for arguments in ([], [ROOT / "scenes/cornell", "--self-test"], ["--self-test", "--case", "nothing"]):
            result = subprocess.run([PROGRAM, "check", *arguments], capture_output=True, text=True, check=False)
            self.assertEqual(2, result.returncode, result.stderr)

    def test_self_test_finds_planted_errors(self):
        code, numbers = check("--self-test")
        self.assertEqual((0, 0), (code, numbers["device_wrong"]))
        for what, cases, file, text, replacement in MUTANTS:
            with self.subTest(what), tempfile.TemporaryDirectory() as folder:
                kernels = pathlib.Path(folder) / "kernels"
                subprocess.run(["cp", "-r", ROOT / "kernels", kernels], check=True)
                source = (kernels / file).read_text()
                self.assertEqual(1, source.count(text), text)
                (kernels / file).write_text(source.replace(text, replacement))
                code, numbers = check("--self-test", "--case", cases, environment={"OBSCURA_KERNEL_DIR": str(kernels), "OBSCURA_CACHE_DIR": folder})
                self.assertEqual(1, code)
                self.assertGreater(numbers["device_wrong"], 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
