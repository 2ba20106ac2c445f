# SPDX-License-Identifier: MIT
"""The simulation of docs/make/fleet.py against known answers: fleet_simulation_test.py SOURCE_FOLDER"""
import itertools
import math
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(sys.argv.pop(), "docs/make")))
import fleet


def optimum(jobs, nodes):
    """By looking at every assignment of jobs to nodes."""
    best = sum(jobs)
    for places in itertools.product(range(nodes), repeat=len(jobs)):
        loads = [0.0] * nodes
        for place, seconds in zip(places, jobs):
            loads[place] += seconds
        best = min(best, max(loads))
    return best


def tasks(variants):
    """Of seconds alone."""
    return [(fleet.Task(split), [fleet.Task(job) for job in jobs], fleet.Task(merge)) for split, jobs, merge in variants]


class Makespan(unittest.TestCase):
    def test_equal_jobs_fill_nodes_in_rounds(self):
        for count, nodes in itertools.product((1, 7, 12), (1, 2, 5, 12, 40)):
            self.assertEqual(fleet.makespan(tasks([(0, [3.0] * count, 0)]), nodes), 3 * math.ceil(count / nodes))

    def test_grahams_worst_case_is_reached(self):
        """2m + 1 jobs of 2m-1, 2m-1, ..., m+1, m+1, m, m, m: LPT takes 4m - 1, the optimum 3m [Graham 1969]."""
        for nodes in (2, 3, 4, 9):
            jobs = [size for size in range(2 * nodes - 1, nodes, -1) for _ in range(2)] + [nodes] * 3
            self.assertEqual(fleet.makespan(tasks([(0, jobs, 0)]), nodes), 4 * nodes - 1)

    def test_is_within_grahams_bound_of_the_optimum(self):
        numbers = random.Random(1)
        for _ in range(40):
            nodes = numbers.choice((2, 3))
            jobs = [numbers.randint(1, 30) for _ in range(numbers.randint(3, 8))]
            best = optimum(jobs, nodes)
            found = fleet.makespan(tasks([(0, jobs, 0)]), nodes)
            self.assertGreaterEqual(found, best)
            self.assertLessEqual(found, (4 / 3 - 1 / (3 * nodes)) * best + 1e-9)

    def test_one_node_does_all_work_and_many_do_the_longest_chain(self):
        variants = tasks([(2.0, [1.0, 5.0, 3.0], 4.0), (1.0, [9.0], 1.0)])
        self.assertEqual(fleet.makespan(variants, 1), 26)
        self.assertEqual(fleet.makespan(variants, 100), 11)

    def test_a_split_goes_before_and_a_merge_after_its_jobs(self):
        self.assertEqual(fleet.makespan(tasks([(2.0, [3.0] * 4, 1.0)]), 2), 2 + 6 + 1)


class FileServer(unittest.TestCase):
    none = fleet.Task(0.0, 0)

    def of(self, jobs, nodes, bandwidth):
        return fleet.makespan([(self.none, [fleet.Task(*job) for job in jobs], self.none)], nodes, bandwidth)

    def test_alone_it_takes_bytes_by_bandwidth(self):
        self.assertAlmostEqual(self.of([(2.0, 30)], 1, 10), 3 + 2)
        self.assertAlmostEqual(self.of([(2.0, 30)] * 3, 1, 10), 3 * (3 + 2))

    def test_together_all_get_an_equal_part(self):
        self.assertAlmostEqual(self.of([(2.0, 30)] * 4, 4, 10), 4 * 3 + 2)
        # The one with 10 bytes moves at half the speed until 2 s, the other has 20 left, which it moves alone.
        self.assertAlmostEqual(self.of([(0.0, 30), (7.0, 10)], 2, 10), 2 + 7)
        self.assertAlmostEqual(self.of([(5.5, 30), (6.0, 10)], 2, 10), 2 + 2 + 5.5)

    def test_is_never_faster_than_its_bounds(self):
        numbers = random.Random(2)
        for _ in range(20):
            jobs = [(numbers.uniform(0, 3), numbers.randint(1, 50)) for _ in range(30)]
            found = self.of(jobs, 7, 20)
            self.assertGreaterEqual(found + 1e-9, sum(b for _, b in jobs) / 20)
            self.assertGreaterEqual(found + 1e-9, sum(s for s, _ in jobs) / 7)


class Jobs(unittest.TestCase):
    parts = [{"triangles": t, "seconds": s} for t, s in ((10, 1.0), (30, 2.0), (5, 0.5), (40, 3.0), (1, 0.3))]

    def test_parts_go_together_up_to_the_triangles(self):
        sizes = [[part["triangles"] for part in job] for job in fleet.jobs_of(self.parts, 40)]
        self.assertEqual(sizes, [[10, 30], [5], [40], [1]])
        self.assertEqual(len(fleet.jobs_of(self.parts, 0)), len(self.parts))

    def test_parts_of_a_job_share_a_process(self):
        parts = [part | {"input_bytes": 100, "output_bytes": 10} for part in self.parts]
        costs = {"parts": parts, "overhead_seconds": 0.25, "split_seconds": 7.0, "merge_seconds": 2.0, "scene_bytes": 5,
                 "split_bytes": 800, "merged_bytes": 400}
        split, jobs, merge = fleet.variant(costs, 40, launch=0.5)
        self.assertEqual((split, merge), ((7.5, 805), (2.5, 800 - 500 + 50 + 400)))
        for found, expected in zip(jobs, (3.25, 1.0, 3.5, 0.8), strict=True):
            self.assertAlmostEqual(found.seconds, expected)
        self.assertEqual([job.bytes for job in jobs], [220, 110, 110, 110])


class Limit(unittest.TestCase):
    def of(self, variant, *rest, **more):
        return fleet.limit(tasks([variant])[0], *rest, **more)

    def test_names_the_bound_that_holds(self):
        self.assertEqual(self.of((1.0, [5.0, 5.0], 1.0), 1, 10, 7.0), "longest job")
        self.assertEqual(self.of((9.0, [1.0, 1.0], 1.0), 1, 10, 11.0), "split and merge of a variant")
        self.assertEqual(self.of((1.0, [5.0, 5.0], 1.0), 1, 1, 12.0), "work")
        self.assertEqual(self.of((0.1, [1.0, 1.0], 0.1), 10, 1, 22.0, start=0.9), "starts of processes")
        self.assertEqual(self.of((0.1, [1.0, 1.0], 0.1), 10, 4, 9.0), "rounds that do not fill the nodes")
        moved = (fleet.Task(1.0, 50), [fleet.Task(1.0, 50)], fleet.Task(1.0))
        self.assertEqual(fleet.limit(moved, 10, 10, 101.0, bandwidth=10), "file server")
        self.assertEqual(fleet.limit(moved, 10, 1, 130.0, bandwidth=10), "work + file server")
        self.assertEqual(fleet.limit(moved, 10, 1, 150.0, bandwidth=10), "rounds that do not fill the nodes")


unittest.main()
