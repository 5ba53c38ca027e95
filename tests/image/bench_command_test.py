#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura bench`: what it reports is there and makes sense, the rays that it writes have the hits that brute force finds,
# and it can be stopped. No test looks at how fast anything was.
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from interrupting import interrupt

import numpy

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/cornell"
SIZE = ["--width", "48", "--height", "48", "--spp", "2"]
QUEUES = ["camera", "shadow", "glossy", "obscurance"]
MISS = 0xFFFFFFFF
RAY = numpy.dtype([("origin", "<f4", 3), ("t_max", "<f4"), ("direction", "<f4", 3), ("t", "<f4"), ("u", "<f4"),
                   ("v", "<f4"), ("primitive", "<u4")])


def bench(*arguments):
    result = subprocess.run([PROGRAM, "bench", SCENE, *map(str, arguments)], capture_output=True, text=True, check=False)
    if result.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
        raise unittest.SkipTest("there is no OpenCL device: " + result.stderr)
    return result


def read_rays(path):
    """Corners of all triangles, and the launches: queue, whether any hit but of panes will do, rays."""
    data = path.read_bytes()
    assert data[:8] == b"OBSCRAYS"
    assert numpy.frombuffer(data, "<u4", 2, 8).tolist() == [2, 0]
    vertex_count, triangle_count = map(int, numpy.frombuffer(data, "<u8", 2, 16))
    vertices = numpy.frombuffer(data, "<f4", 3 * vertex_count, 32).reshape(-1, 3)
    triangles = numpy.frombuffer(data, "<u4", 4 * triangle_count, 32 + 12 * vertex_count).reshape(-1, 4)
    assert not triangles[:, 3].any(), "the scene has no panes"
    place, launches = 32 + 12 * vertex_count + 16 * triangle_count, []
    while place < len(data):
        queue, query = map(int, numpy.frombuffer(data, "<u4", 2, place))
        count = int(numpy.frombuffer(data, "<u8", 1, place + 8)[0])
        launches.append((QUEUES[queue], query >= 1, numpy.frombuffer(data, RAY, count, place + 16)))
        place += 16 + count * RAY.itemsize
    assert place == len(data)
    return vertices[triangles[:, :3]].astype(float), launches


def intersect(corners, ray):
    """The nearest hit in (0, t_max) by solving origin + t direction = a + u (b - a) + v (c - a): t, u, v, triangle; or None."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    origin, direction = ray["origin"].astype(float), ray["direction"].astype(float)
    matrix = numpy.stack([numpy.broadcast_to(-direction, a.shape), b - a, c - a], axis=2)
    crossing = numpy.abs(numpy.linalg.det(matrix)) > 1e-12
    hits = numpy.full(a.shape, numpy.inf)
    hits[crossing] = numpy.linalg.solve(matrix[crossing], (origin - a[crossing])[..., None])[..., 0]
    t, u, v = hits.T
    inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < ray["t_max"])
    if not inside.any():
        return None
    nearest = numpy.argmin(numpy.where(inside, t, numpy.inf))
    return t[nearest], u[nearest], v[nearest], nearest


class Bench(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_json_holds_every_figure(self):
        result = bench(*SIZE, "--quiet", "--json", "-")
        self.assertEqual((0, ""), (result.returncode, result.stderr))
        numbers = json.loads(result.stdout)
        self.assertEqual(QUEUES, list(numbers["queues"]))
        self.assertEqual((True, True, 32), (numbers["passed"], numbers["complete"], numbers["triangles"]))
        for side in ("device", "embree_robust", "embree_fast"):
            for figure in ("bytes", "bytes_per_triangle", "build_seconds"):
                self.assertGreater(numbers["bvh"][side][figure], 0, side)
        self.assertEqual(48 * 48 * 2, numbers["queues"]["camera"]["rays"])
        for name in ("camera", "shadow", "obscurance"):
            with self.subTest(name):
                queue = numbers["queues"][name]
                self.assertTrue(queue["agrees"])
                self.assertGreaterEqual(queue["nodes_per_ray"], 1)  # the root
                self.assertGreater(queue["blocks_per_ray"], 0)
                self.assertEqual(28, len(queue["modes"]))
                for mode in queue["modes"]:
                    self.assertGreater(mode["mrays"], 0)
                for kind, figures in (("robust", queue), ("fast", queue["fast"])):
                    self.assertTrue(figures["embree_mode"].startswith(kind), figures["embree_mode"])
                    self.check_pairs(figures, queue["rays"])

    def check_pairs(self, figures, rays):
        """The figures are those of the times beside them."""
        device, embree = (numpy.array(figures[side + "_seconds"]) for side in ("device", "embree"))
        self.assertEqual(7, len(device))
        for name, values in (("device_mrays", rays / device / 1e6), ("embree_mrays", rays / embree / 1e6),
                             ("ratio", embree / device)):
            self.assertGreater(values.min(), 0)
            for suffix, value in (("", numpy.median(values)), ("_min", values.min()), ("_max", values.max())):
                self.assertAlmostEqual(1, figures[name + suffix] / value, 9, name + suffix)

    def test_queue_without_rays_has_no_figures(self):
        glossy = json.loads(bench(*SIZE, "--quiet", "--json", "-").stdout)["queues"]["glossy"]
        self.assertEqual(0, glossy["rays"])
        self.assertEqual([None] * 3, [glossy[name] for name in ("ratio", "device_mrays", "embree_mode")])

    def test_table_has_the_queues_and_says_what_is_compared(self):
        result = bench(*SIZE)
        self.assertEqual(0, result.returncode, result.stderr)
        for text in ("camera", "shadow", "obscurance", "device / Embree", "packets of 8", "bytes per triangle", "nodes per ray"):
            self.assertIn(text, result.stdout)
        self.assertNotIn("glossy", result.stdout)

    def test_what_is_rendered_twice_is_warned_of_once(self):
        result = bench("--width", 48, "--height", 36, "--spp", 1)
        self.assertEqual(1, result.stderr.count("aspect ratio"), result.stderr)

    def test_dumped_rays_have_the_hits_of_brute_force(self):
        file = self.folder / "cornell.rays"
        # The step without colours asks its obscurance rays only whether there is a hit.
        self.assertEqual(0, bench(*SIZE, "--rho", "step", "--bleeding", "off", "--dump-rays", file).returncode)
        corners, launches = read_rays(file)
        self.assertEqual((32, 3, 3), corners.shape)
        queries = {queue: any_hit for queue, any_hit, _ in launches}
        self.assertEqual({"camera": False, "shadow": True, "obscurance": True}, queries)
        for queue, any_hit, rays in launches:
            self.assertGreater(len(rays), 1000)
            for ray in rays[:: max(1, len(rays) // 100)]:
                with self.subTest(queue=queue, ray=ray):
                    expected = intersect(corners, ray)
                    self.assertEqual(expected is None, ray["primitive"] == MISS)
                    if expected is None or any_hit:
                        continue
                    self.assertEqual(expected[3], ray["primitive"])
                    for value, name in zip(expected, ("t", "u", "v")):
                        self.assertAlmostEqual(value, float(ray[name]), 4)

    def test_kernels_that_answer_wrongly_have_no_ratio(self):
        kernels = self.folder / "kernels"
        subprocess.run(["cp", "-r", SCENE.parents[1] / "kernels", kernels], check=True)
        rays = kernels / "lib/queued_rays.clh"
        source = rays.read_text(encoding="utf-8")
        self.assertEqual(1, source.count("INFINITY)"), "the reach of camera and glossy rays")
        rays.write_text(source.replace("INFINITY)", "1.0f)"), encoding="utf-8")
        environment = {**os.environ, "OBSCURA_KERNEL_DIR": str(kernels), "OBSCURA_CACHE_DIR": str(self.folder)}
        result = subprocess.run([PROGRAM, "bench", SCENE, *SIZE, "--quiet", "--json", "-"], capture_output=True, text=True,
                                check=False, env=environment)
        self.assertEqual(1, result.returncode, result.stderr)
        numbers = json.loads(result.stdout)
        self.assertFalse(numbers["passed"])
        self.assertIsNone(numbers["queues"]["camera"]["ratio"])
        self.assertGreater(numbers["queues"]["camera"]["differing"], 1000)

    def test_interrupt_stops_after_the_work_in_hand(self):
        command = [PROGRAM, "bench", SCENE, "--width", "2000", "--height", "2000", "--dump-rays", self.folder / "x.rays"]
        code, output, messages = interrupt(command, "bench: ")  # the first report of progress
        self.assertEqual(4, code, messages)
        self.assertIn("there are no figures", messages)
        self.assertEqual("", output)

    def test_outputs_are_checked_before_the_work(self):
        for arguments, message in ((["--dump-rays", "-"], "rays are written to files only"),
                                   (["--dump-rays", self.folder / "no/such"], "does not exist"),
                                   (["--json", self.folder / "x", "--dump-rays", self.folder / "x"], "the same file")):
            result = bench(*SIZE, *arguments)
            self.assertEqual(2, result.returncode, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertEqual("", result.stdout)
        self.assertEqual([], list(self.folder.iterdir()))


if __name__ == "__main__":
    unittest.main()
