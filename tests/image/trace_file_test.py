#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# `obscura render --trace`: whatever the host and the device did is there, on one clock, as the other figures of the run
# have it.
import collections
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from interrupting import interrupt

PROGRAM = os.environ["OBSCURA_PROGRAM"]
SCENE = pathlib.Path(__file__).resolve().parents[2] / "scenes/cornell"
SMALL = ["--width", "64", "--height", "48", "--obscurance-rays", "3", "--wave-size", "4096", "--quiet"]
HOST, DEVICE = 1, 2  # processes
# How the rest of the programs come into the cache where several cores compile them.
FILLED = {"filled by another process"} if os.cpu_count() > 1 else set()


def render(folder, *arguments, **environment):
    """Exit code, messages, events of the trace and the statistics of a small render."""
    command = [PROGRAM, "render", SCENE, "-o", folder / "x.exr", "--trace", folder / "trace.json",
               "--stats", folder / "stats.json", *SMALL, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, **environment})
    if done.returncode == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
        raise unittest.SkipTest("there is no OpenCL device: " + done.stderr)
    assert done.returncode == 0, done.stderr
    return read_events(folder), json.loads((folder / "stats.json").read_text(encoding="utf-8"))


def read_events(folder):
    return json.loads((folder / "trace.json").read_text(encoding="utf-8"))["traceEvents"]


def slices(events, category=None, process=None):
    return [event for event in events if event["ph"] == "X" and category in (None, event["cat"])
            and process in (None, event["pid"])]


def nanoseconds(slice_):
    """Start and end. The file has microseconds with three digits behind the point."""
    return round(1000 * slice_["ts"]), round(1000 * slice_["ts"]) + round(1000 * slice_["dur"])


class Trace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        # A cache of its own, empty first, so that it is known which programs are in it.
        caches = {"OBSCURA_CACHE_DIR": str(cls.folder), "POCL_CACHE_DIR": str(cls.folder)}
        cls.cold, _ = render(cls.folder, "--spp", "1", **caches)
        cls.events, cls.stats = render(cls.folder, "--spp", "4", **caches)

    def test_every_launch_of_every_stage_is_a_slice(self):
        launches = collections.Counter(event["name"] for event in slices(self.events, "kernel"))
        self.assertEqual({name: row["launches"] for name, row in self.stats["kernels"].items()}, launches)
        self.assertIn("shadow", launches)
        grids = [event["args"]["work items"] for event in slices(self.events, "kernel") if event["name"] == "camera"]
        self.assertGreaterEqual(sum(grids), self.stats["rays"]["camera"])

    def test_slices_of_a_stage_add_up_to_its_milliseconds(self):
        for name, row in self.stats["kernels"].items():
            ms = sum(event["dur"] for event in slices(self.events, "kernel") if event["name"] == name) / 1000
            self.assertAlmostEqual(row["ms"], ms, delta=0.001 * row["ms"] + 1e-5 * row["launches"], msg=name)

    def test_transfers_are_there_with_their_bytes(self):
        transfers = {event["name"]: event["args"]["bytes"] for event in slices(self.events, "transfer", DEVICE)}
        self.assertGreater(transfers["upload nodes"], 0)
        self.assertEqual(transfers["clear counters"], transfers["download counters"])
        self.assertEqual(self.stats["bytes"]["film"], transfers["map film"])

    def test_programs_tell_whether_they_were_compiled(self):
        stages = {"compile " + name.split("_")[0] for name in self.stats["kernels"]}
        cold, warm = ({event["name"]: event["args"]["cache"] for event in slices(events, "compile", HOST)}
                      for events in (self.cold, self.events))
        self.assertEqual({stage: "hit" for stage in stages}, warm)
        self.assertEqual(stages, set(cold))
        self.assertEqual({"miss", *FILLED}, set(cold.values()))
        waits = {event["name"] for event in slices(self.cold, "host", HOST)} & {"wait for another process"}
        self.assertEqual(len(FILLED), len(waits))

    def test_steps_of_the_host_are_there(self):
        steps = slices(self.events, "host", HOST)
        names = {event["name"] for event in steps}
        self.assertLessEqual({"load", "open device", "build BVH", "wave", "depth 0", "wait", "develop", "write picture"}, names)
        numbers = [event["args"]["number"] for event in steps if event["name"] == "wave"]
        self.assertEqual(list(range(len(numbers))), numbers)

    def test_launches_that_only_warm_up_are_told_apart(self):
        others = {event["name"] for event in slices(self.cold, "kernel")} - set(self.stats["kernels"])
        self.assertEqual(set(), {name for name in others if not name.startswith("warm-up of ")})

    def test_slices_of_a_row_nest(self):
        for events in (self.cold, self.events):
            rows = collections.defaultdict(list)
            for event in slices(events):
                rows[event["pid"], event["tid"]].append(nanoseconds(event))
            self.assertGreaterEqual(len(rows), 3)  # main, the builder of the BVH, the device
            for row in rows.values():
                open_ends = []
                for start, end in sorted(row, key=lambda times: (times[0], -times[1])):
                    self.assertLessEqual(start, end)
                    while open_ends and open_ends[-1] <= start:
                        open_ends.pop()
                    self.assertTrue(not open_ends or end <= open_ends[-1], "slices overlap")
                    open_ends.append(end)

    def test_kernels_run_while_the_host_is_in_their_wave(self):
        waves = [nanoseconds(event) for event in slices(self.events, "host") if event["name"] == "wave"]
        self.assertEqual(self.stats["kernels"]["camera"]["launches"], len(waves))
        for event in slices(self.events, "kernel"):
            start, end = nanoseconds(event)
            # The clocks are known to some microseconds.
            self.assertTrue(any(first - 50_000 <= start and end <= last + 50_000 for first, last in waves), event)

    def test_queue_lengths_add_up_to_the_rays(self):
        lengths = collections.Counter()
        for event in self.events:
            if event["ph"] == "C":
                self.assertEqual(DEVICE, event["pid"])
                lengths[event["name"]] += event["args"]["queued"]
        last = {event["name"]: event["args"]["queued"] for event in self.events if event["ph"] == "C"}
        self.assertEqual({0}, set(last.values()))
        rays = self.stats["rays"]
        self.assertEqual({"camera rays": rays["camera"], "shadow rays": rays["shadow"], "glossy rays": rays["glossy"],
                          "obscurance points": rays["obscurance"] // self.stats["obscurance_rays"]}, lengths)

    def test_rows_have_names(self):
        names = {(event["name"], event["pid"], event.get("tid")): event["args"]["name"]
                 for event in self.events if event["ph"] == "M"}
        self.assertEqual("main", names["thread_name", HOST, 1])
        self.assertEqual(self.stats["device"], names["process_name", DEVICE, None])
        named = {key[1:] for key in names if key[0] == "thread_name"}
        self.assertEqual(named, {(event["pid"], event["tid"]) for event in slices(self.events)})

    def test_standard_output_is_refused(self):
        done = subprocess.run([PROGRAM, "render", SCENE, "-o", self.folder / "x.exr", "--trace", "-"], capture_output=True,
                              text=True, check=False)
        self.assertEqual(2, done.returncode)
        self.assertIn("--trace -", done.stderr)


class Interrupted(unittest.TestCase):
    def interrupt(self, line_start, **environment):
        """The events of a render that was interrupted when a line of its messages began so."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            command = [PROGRAM, "render", SCENE, "-o", folder / "x.exr", "--trace", folder / "trace.json",
                       *SMALL[:-1], "--spp", str(1 << 20)]
            code, _, messages = interrupt(command, line_start, {key: value or name for key, value in environment.items()})
            if code == 3 and os.environ.get("OBSCURA_REQUIRE_DEVICE") != "1":
                self.skipTest("there is no OpenCL device: " + messages)
            self.assertEqual(4, code, messages)
            return read_events(folder)

    def test_interrupted_render_leaves_a_whole_trace(self):
        self.assertGreater(len(slices(self.interrupt("render: "), "kernel")), 0)

    def test_render_interrupted_before_its_first_wave_leaves_the_compilations(self):
        events = self.interrupt(SCENE.name, OBSCURA_CACHE_DIR="", POCL_CACHE_DIR="")
        self.assertEqual({"miss", *FILLED}, {event["args"]["cache"] for event in slices(events, "compile")})


if __name__ == "__main__":
    unittest.main()
