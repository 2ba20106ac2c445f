#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures what the jobs of a bake cost: fleet_costs.py PAPILLA SCENE MATERIALS COSTS.json

Splits by part in a folder of its own, does every job, one process and one thread each, does them again (then nothing
is left to compute, and what remains is the overhead), merges. Then splits and does it all once more in another folder
with a shared cache that the first time has filled. Seconds are processor time, of user and system; bytes are those of
the files that a process reads or writes, each counted once."""
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

PER_TICK = 1 / os.sysconf("SC_CLK_TCK")


def cpu_seconds(*command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 3)


def cpu_so_far(process):
    """Of a running process, the children that it waited for, and those that run."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    children = Path(f"/proc/{process}/task/{process}/children").read_text(encoding="utf-8").split()
    return sum(map(int, fields[11:15])) * PER_TICK + sum(map(cpu_so_far, children))


def cpu_until(stage, *command):
    """Processor time until a command's progress first comes to a stage. The rest is done, too."""
    spent = None
    with subprocess.Popen([*command, "--progress", "json"], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                          text=True) as running:
        for line in running.stderr:
            if spent is None and json.loads(line)["stage"] == stage:
                spent = round(cpu_so_far(running.pid), 2)
    if running.returncode or spent is None:
        sys.exit(f"{command}: exit code {running.returncode}, stage {stage!r} {'not ' if spent is None else ''}reached")
    return spent


def folder_bytes(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def processor():
    models = [line.partition(":")[2].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
              if line.startswith("model name")]
    return models[0] if models else platform.machine()


def measure(papilla, scene, materials):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        jobs, again, cache, output = (folder / part for part in ("jobs", "again", "cache", "scene.glb"))
        common = ("--quiet", "--threads", "1")
        uncached, cached = (*common, "--cache", "none"), (*common, "--cache", cache)
        split = (papilla, "split", scene, "-m", materials, "-o")

        def job(part, options, of=jobs):
            return cpu_seconds(papilla, "bake", "--job", of / part["id"], *options)

        costs = {"papilla": subprocess.run([papilla, "--version"], check=True, capture_output=True, text=True).stdout.strip(),
                 "processor": processor(), "processors": os.cpu_count(), "scene": Path(scene).name,
                 "start_seconds": statistics.median(cpu_seconds(papilla, "--version") for _ in range(9)),
                 "split_seconds": cpu_seconds(*split, jobs, *uncached), "scene_bytes": Path(scene).stat().st_size,
                 "split_bytes": folder_bytes(jobs), "parts": []}
        for line in (jobs / "manifest.jsonl").read_text(encoding="utf-8").splitlines():
            manifest = json.loads(line)
            part = {"id": manifest["id"], "triangles": manifest["triangles"], "estimate": manifest["cost_seconds"]}
            before = folder_bytes(jobs)
            part["seconds"] = job(part, uncached)
            part["input_bytes"] = sum(file["bytes"] for file in manifest["inputs"])
            part["output_bytes"] = folder_bytes(jobs) - before
            costs["parts"].append(part)
        costs["overhead_seconds"] = statistics.median(job(part, uncached) for part in costs["parts"])
        costs["merge_seconds"] = cpu_seconds(papilla, "merge", jobs, "-o", output, *common)
        costs["merged_bytes"] = output.stat().st_size
        whole = folder / "whole.glb"
        costs["bake_seconds"] = cpu_seconds(papilla, "bake", scene, "-m", materials, "-o", whole, *cached)
        if whole.read_bytes() != output.read_bytes():
            sys.exit("the merged file is another one than the whole bake")
        costs["split_cached_seconds"] = cpu_seconds(*split, again, *cached)
        costs["job_cached_seconds"] = statistics.median(job(part, cached, again) for part in costs["parts"])
        costs["cad_open_seconds"] = cpu_until("tessellate", *split, folder / "open", *uncached)
        return costs


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    Path(sys.argv[4]).write_text(json.dumps(measure(*sys.argv[1:4]), indent=1) + "\n", encoding="utf-8")
