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


class Makespan(unittest.TestCase):
    def test_equal_jobs_fill_nodes_in_rounds(self):
        for count, nodes in itertools.product((1, 7, 12), (1, 2, 5, 12, 40)):
            self.assertEqual(fleet.makespan([(0, [3.0] * count, 0)], nodes), 3 * math.ceil(count / nodes))

    def test_grahams_worst_case_is_reached(self):
        """2m + 1 jobs of 2m-1, 2m-1, ..., m+1, m+1, m, m, m: LPT takes 4m - 1, the optimum 3m [Graham 1969]."""
        for nodes in (2, 3, 4, 9):
            jobs = [size for size in range(2 * nodes - 1, nodes, -1) for _ in range(2)] + [nodes] * 3
            self.assertEqual(fleet.makespan([(0, jobs, 0)], nodes), 4 * nodes - 1)

    def test_is_within_grahams_bound_of_the_optimum(self):
        numbers = random.Random(1)
        for _ in range(40):
            nodes = numbers.choice((2, 3))
            jobs = [numbers.randint(1, 30) for _ in range(numbers.randint(3, 8))]
            best = optimum(jobs, nodes)
            found = fleet.makespan([(0, jobs, 0)], nodes)
            self.assertGreaterEqual(found, best)
            self.assertLessEqual(found, (4 / 3 - 1 / (3 * nodes)) * best + 1e-9)

    def test_one_node_does_all_work_and_many_do_the_longest_chain(self):
        variants = [(2.0, [1.0, 5.0, 3.0], 4.0), (1.0, [9.0], 1.0)]
        self.assertEqual(fleet.makespan(variants, 1), 26)
        self.assertEqual(fleet.makespan(variants, 100), 11)

    def test_a_split_goes_before_and_a_merge_after_its_jobs(self):
        self.assertEqual(fleet.makespan([(2.0, [3.0] * 4, 1.0)], 2), 2 + 6 + 1)


class Jobs(unittest.TestCase):
    parts = [{"triangles": t, "seconds": s} for t, s in ((10, 1.0), (30, 2.0), (5, 0.5), (40, 3.0), (1, 0.3))]

    def test_parts_go_together_up_to_the_triangles(self):
        sizes = [[part["triangles"] for part in job] for job in fleet.jobs_of(self.parts, 40)]
        self.assertEqual(sizes, [[10, 30], [5], [40], [1]])
        self.assertEqual(len(fleet.jobs_of(self.parts, 0)), len(self.parts))

    def test_parts_of_a_job_share_a_process(self):
        costs = {"parts": self.parts, "overhead_seconds": 0.25, "split_seconds": 7.0, "merge_seconds": 2.0}
        split, jobs, merge = fleet.variant(costs, 40, launch=0.5)
        self.assertEqual((split, merge), (7.5, 2.5))
        for found, expected in zip(jobs, (3.25, 1.0, 3.5, 0.8), strict=True):
            self.assertAlmostEqual(found, expected)


class Limit(unittest.TestCase):
    def test_names_the_bound_that_holds(self):
        self.assertEqual(fleet.limit((1.0, [5.0, 5.0], 1.0), 1, 10, 7.0, 0.1), "longest job")
        self.assertEqual(fleet.limit((9.0, [1.0, 1.0], 1.0), 1, 10, 11.0, 0.1), "split and merge of a variant")
        self.assertEqual(fleet.limit((1.0, [5.0, 5.0], 1.0), 1, 1, 12.0, 0.1), "work")
        self.assertEqual(fleet.limit((0.1, [1.0, 1.0], 0.1), 10, 1, 22.0, 0.9), "overhead")


unittest.main()
