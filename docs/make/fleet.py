#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How long a programme of variants takes on m nodes, from measured costs: fleet.py COSTS.json OUT.csv

A variant is a split, then its jobs, then a merge; variants do not wait for one another. A node does one thing at a
time, with one core. List scheduling: whenever a node is free it takes, of what is ready, that with the longest chain
after it [Graham 1969]; of independent jobs this is LPT, at most 4/3 - 1/(3m) times the optimum."""
import csv
import heapq
import json
import sys
from pathlib import Path

VARIANTS = 200
LAUNCHES = (0.0, 1.0)  # s that a cluster needs to start a process on a node
NODES = (1, 2, 5, 10, 20, 50, 100, 200, 300, 500, 700, 1000)
TRIANGLES = (0, 20000, 50000, 100000)  # of a job; 0: one a part


def makespan(variants, nodes):
    """Seconds until all is done. variants: (split, [job, ...], merge), in seconds each."""
    ready = []  # (negative length of the chain from here on, variant, kind, seconds)
    for v, (split, jobs, merge) in enumerate(variants):
        heapq.heappush(ready, (-(split + max(jobs) + merge), v, "split", split))
    open_jobs = [len(jobs) for _, jobs, _ in variants]
    running, now, free = [], 0.0, nodes
    while ready or running:
        while ready and free:
            _, v, kind, seconds = heapq.heappop(ready)
            heapq.heappush(running, (now + seconds, v, kind))
            free -= 1
        now, v, kind = heapq.heappop(running)
        free += 1
        _, jobs, merge = variants[v]
        if kind == "split":
            for seconds in jobs:
                heapq.heappush(ready, (-(seconds + merge), v, "job", seconds))
        elif kind == "job":
            open_jobs[v] -= 1
            if not open_jobs[v]:
                heapq.heappush(ready, (-merge, v, "merge", merge))
    return now


def jobs_of(parts, triangles):
    """Parts together to jobs as papilla split does it: in their order, up to so many triangles; no part is divided."""
    jobs, count = [], 0
    for part in parts:
        if not jobs or count + part["triangles"] > triangles:
            jobs.append([])
            count = 0
        jobs[-1].append(part)
        count += part["triangles"]
    return jobs


def variant(costs, triangles, launch=0.0):
    """One variant's (split, jobs, merge). A part's time is measured with its process; one process a job remains.
    launch: what the cluster needs to start a process on a node."""
    overhead = costs["overhead_seconds"]
    jobs = [launch + overhead + sum(max(part["seconds"] - overhead, 0) for part in job)
            for job in jobs_of(costs["parts"], triangles)]
    return launch + costs["split_seconds"], jobs, launch + costs["merge_seconds"]


def limit(one, count, nodes, seconds, start):
    """What keeps it from being faster: name of the larger bound, and of its largest share. start: of one process."""
    split, jobs, merge = one
    work = count * (split + sum(jobs) + merge) / nodes
    chain = split + max(jobs) + merge
    if chain >= work:
        return "longest job" if max(jobs) > split + merge else "split and merge of a variant"
    if seconds > 1.1 * work:
        return "rounds that do not fill the nodes"
    return "overhead" if start * len(jobs) > 0.5 * (split + sum(jobs) + merge) else "work"


def table(costs, launch):
    for triangles in TRIANGLES:
        one = variant(costs, triangles, launch)
        for nodes in NODES:
            seconds = makespan([one] * VARIANTS, nodes)
            work = VARIANTS * (one[0] + sum(one[1]) + one[2])
            yield {"by": f"triangles={triangles}" if triangles else "part", "jobs": VARIANTS * len(one[1]),
                   "launch_s": launch, "nodes": nodes, "makespan_s": round(seconds, 2),
                   "efficiency": round(work / (nodes * seconds), 3), "work_s": round(work, 1),
                   "limit": limit(one, VARIANTS, nodes, seconds, launch + costs["overhead_seconds"])}


def main(costs_path, csv_path):
    costs = json.loads(Path(costs_path).read_text(encoding="utf-8"))
    rows = [row for launch in LAUNCHES for row in table(costs, launch)]
    with open(csv_path, "w", encoding="utf-8", newline="") as out:
        writer = csv.DictWriter(out, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
