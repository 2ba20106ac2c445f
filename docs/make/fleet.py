#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How long a programme of variants takes on m nodes, from measured costs: fleet.py COSTS.json OUT.csv [PAGE.md]

A variant is a split, then its jobs, then a merge; variants do not wait for one another. A node does one thing at a
time, with one core: it moves the bytes of a task, then computes. All share one file server, each of those that move
bytes getting an equal part of it (processor sharing). List scheduling: whenever a node is free it takes, of what is
ready, that with the longest chain after it [Graham 1969]; of independent jobs this is LPT, at most 4/3 - 1/(3m) times
the optimum. In PAGE.md what stands between <!-- fleet.py: NAME --> and <!-- end --> is written anew."""
import csv
import heapq
import json
import math
import re
import sys
from collections import namedtuple
from pathlib import Path

VARIANTS = 200
LAUNCHES = (0.0, 1.0)  # s that a cluster needs to start a process on a node
NODES = (1, 2, 5, 10, 20, 50, 100, 200, 300, 500, 700, 1000)
TRIANGLES = (0, 20000, 50000, 100000)  # of a job; 0: one a part
FILE_SERVER = 1e9  # bytes a second

Task = namedtuple("Task", "seconds bytes", defaults=(0,))


def makespan(variants, nodes, bandwidth=math.inf):
    """Seconds until all is done. variants: (split, [job, ...], merge), Tasks."""
    ready = []  # (negative length of the chain from here on, variant, kind, task)
    for v, (split, jobs, merge) in enumerate(variants):
        heapq.heappush(ready, (-(split.seconds + max(jobs).seconds + merge.seconds), v, "split", split))
    open_jobs = [len(jobs) for _, jobs, _ in variants]
    computing = []  # (end, variant, kind)
    moving = []  # (what `moved` is at the end, variant, kind, seconds that follow)
    now, moved, free = 0.0, 0.0, nodes  # moved: bytes of one that has been moving all the time
    while ready or computing or moving:
        while ready and free:
            _, v, kind, task = heapq.heappop(ready)
            heapq.heappush(moving, (moved + task.bytes, v, kind, task.seconds))
            free -= 1
        share = bandwidth / len(moving) if moving else 0.0
        moves_end = now + (moving[0][0] - moved) / share if moving else math.inf
        if moves_end <= (computing[0][0] if computing else math.inf):
            now = moves_end
            moved, v, kind, seconds = heapq.heappop(moving)
            heapq.heappush(computing, (now + seconds, v, kind))
            continue
        end, v, kind = heapq.heappop(computing)
        if moving:
            moved += (end - now) * share
        now = end
        free += 1
        _, jobs, merge = variants[v]
        if kind == "split":
            for job in jobs:
                heapq.heappush(ready, (-(job.seconds + merge.seconds), v, "job", job))
        elif kind == "job":
            open_jobs[v] -= 1
            if not open_jobs[v]:
                heapq.heappush(ready, (-merge.seconds, v, "merge", merge))
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


def total(parts, field):
    return sum(part[field] for part in parts)


def variant(costs, triangles, launch=0.0):
    """One variant's (split, jobs, merge). A part's time is measured with its process; one process a job remains.
    launch: what the cluster needs to start a process on a node."""
    overhead, parts = costs["overhead_seconds"], costs["parts"]
    jobs = [Task(launch + overhead + sum(max(part["seconds"] - overhead, 0) for part in job),
                 total(job, "input_bytes") + total(job, "output_bytes")) for job in jobs_of(parts, triangles)]
    return (Task(launch + costs["split_seconds"], costs["scene_bytes"] + costs["split_bytes"]), jobs,
            Task(launch + costs["merge_seconds"], merge_read_bytes(costs) + costs["merged_bytes"]))


def merge_read_bytes(costs):
    """What the split put into the store, and the results of the jobs."""
    return costs["split_bytes"] - total(costs["parts"], "input_bytes") + total(costs["parts"], "output_bytes")


def sums(one):
    """Of a variant: (seconds, bytes)."""
    split, jobs, merge = one
    tasks = [split, *jobs, merge]
    return sum(task.seconds for task in tasks), sum(task.bytes for task in tasks)


def limit(one, count, nodes, seconds, start=0.0, bandwidth=math.inf):
    """What keeps it from being faster: of the bounds by nodes, by the chain of one variant and by the file server the
    largest, or the sum of two that alternate. start: what a process costs before its work."""
    split, jobs, merge = one
    work, data = sums(one)
    by_nodes, by_server = count * work / nodes, count * data / bandwidth
    chain = split.seconds + max(jobs).seconds + merge.seconds
    if by_nodes > chain:
        name = "starts of processes" if start * len(jobs) > 0.5 * work else "work"
    else:
        name = "longest job" if max(jobs).seconds > split.seconds + merge.seconds else "split and merge of a variant"
    most = max(by_nodes, chain)
    if seconds <= 1.1 * by_server:
        return "file server"
    if seconds <= 1.1 * most:
        return name
    return f"{name} + file server" if seconds <= 1.1 * (most + by_server) else "rounds that do not fill the nodes"


def table(costs, launch):
    for triangles in TRIANGLES:
        one = variant(costs, triangles, launch)
        for nodes in NODES:
            seconds = makespan([one] * VARIANTS, nodes, FILE_SERVER)
            work, data = sums(one)
            yield {"by": f"triangles={triangles}" if triangles else "part", "jobs": VARIANTS * len(one[1]),
                   "launch_s": launch, "nodes": nodes, "makespan_s": round(seconds, 2),
                   "efficiency": round(VARIANTS * work / (nodes * seconds), 3), "work_s": round(VARIANTS * work, 1),
                   "bytes": VARIANTS * data,
                   "limit": limit(one, VARIANTS, nodes, seconds, launch + costs["overhead_seconds"], FILE_SERVER)}


def shown(seconds):
    return f"{seconds:,.0f} s" if seconds >= 100 else f"{seconds:.1f} s" if seconds >= 1 else f"{seconds:.2f} s"


def megabytes(count):
    return f"{count / 1e6:,.1f} MB" if count < 1e9 else f"{count / 1e9:,.1f} GB"


def costs_text(costs):
    parts = costs["parts"]
    longest = max(parts, key=lambda part: part["seconds"])
    largest = max(parts, key=lambda part: part["input_bytes"])
    rows = [("start of the program", shown(costs["start_seconds"])),
            ("split: open the CAD file, tessellate, plan, make the grains", shown(costs["split_seconds"])),
            ("... of this, open the CAD file", shown(costs["cad_open_seconds"])),
            (f"all {len(parts)} jobs, one a part", shown(total(parts, "seconds"))),
            (f"the longest, `{longest['id']}`, {longest['triangles']:,} triangles", shown(longest["seconds"])),
            ("a job with nothing left to do: start, check of its result, end", shown(costs["overhead_seconds"])),
            ("merge", shown(costs["merge_seconds"])),
            ("the whole bake in one process", shown(costs["bake_seconds"])),
            ("split, all of it in a shared cache", shown(costs["split_cached_seconds"])),
            ("a job, its results in a shared cache (median)", shown(costs["job_cached_seconds"])),
            ("inputs of the jobs", f"{megabytes(total(parts, 'input_bytes'))}, the largest {megabytes(largest['input_bytes'])}"),
            ("what split writes, inputs of the jobs included", megabytes(costs["split_bytes"])),
            ("what the jobs write", megabytes(total(parts, "output_bytes"))),
            ("what merge reads", megabytes(merge_read_bytes(costs))),
            ("the merged file", megabytes(costs["merged_bytes"]))]
    in_every_job = VARIANTS * len(parts) * costs["cad_open_seconds"]
    return "\n".join(["| | |", "| --- | --- |", *(f"| {name} | {value} |" for name, value in rows), "",
                      f"One run of one thread a process on {costs['processor']}, {costs['processors']} processors that had other"
                      f" work, too. A job starts no CAD library: opening the file in each of {VARIANTS * len(parts):,} jobs,"
                      f" as `split` avoids it, would take {in_every_job / 3600:.1f} h of one core."])


def makespan_text(costs, rows):
    columns = [("part", 0.0), ("triangles=50000", 0.0), ("part", 1.0), ("triangles=50000", 1.0)]
    by = {(row["by"], row["launch_s"], row["nodes"]): row for row in rows}
    lines = ["| nodes | by part | by 50,000 triangles | by part, 1 s to start a process | by 50,000 triangles, 1 s to start |",
             "| --- | --- | --- | --- | --- |"]
    for nodes in (1, 10, 100, 200, 500, 1000):
        cells = [by[(*column, nodes)] for column in columns]
        lines.append(f"| {nodes:,} | " + " | ".join(f"{shown(row['makespan_s'])}: {row['limit']}" for row in cells) + " |")
    one = variant(costs, 0)
    data = sums(one)[1]
    faster = makespan([one] * VARIANTS, 1000, 10 * FILE_SERVER)
    part, together = (by[(*column, 1000)] for column in columns[2:])
    lines += ["", f"A variant moves {megabytes(data)}, all of them {megabytes(VARIANTS * data)}, which alone takes the file server"
              f" {shown(VARIANTS * data / FILE_SERVER)}. A variant's chain of split, longest job and merge computes for"
              f" {shown(one[0].seconds + max(one[1]).seconds + one[2].seconds)}, which no number of nodes shortens. With a file server"
              f" of {10 * FILE_SERVER / 1e9:.0f} GB/s, 1,000 nodes take {shown(faster)} by part. With 1 s to start a process,"
              f" {part['jobs']:,} jobs by part take {part['work_s'] / 3600:.1f} h of one core, {together['jobs']:,} by 50,000"
              f" triangles {together['work_s'] / 3600:.1f} h."]
    return "\n".join(lines)


def write_page(path, texts):
    page = path.read_text(encoding="utf-8")
    for name, text in texts.items():
        page, count = re.subn(rf"(<!-- fleet.py: {name} -->\n).*?(?=<!-- end -->)",
                              lambda mark, text=text: f"{mark[1]}{text}\n", page, flags=re.DOTALL)
        if count != 1:
            sys.exit(f"{path}: has no place for {name}")
    path.write_text(page, encoding="utf-8")


def main(costs_path, csv_path, page_path=None):
    costs = json.loads(Path(costs_path).read_text(encoding="utf-8"))
    rows = [row for launch in LAUNCHES for row in table(costs, launch)]
    with open(csv_path, "w", encoding="utf-8", newline="") as out:
        writer = csv.DictWriter(out, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    if page_path:
        write_page(Path(page_path), {"costs": costs_text(costs), "makespan": makespan_text(costs, rows)})


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
