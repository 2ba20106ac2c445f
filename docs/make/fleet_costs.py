#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures what the jobs of a bake cost: fleet_costs.py PAPILLA SCENE MATERIALS COSTS.json

Splits by part in a folder of its own, does every job, one process and one thread each, does them again (then nothing
is left to compute, and what remains is the overhead), merges. Seconds are processor time, of user and system."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path


def cpu_seconds(*command):
    before = os.times()
    subprocess.run(command, check=True)
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def folder_bytes(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def measure(papilla, scene, materials):
    with tempfile.TemporaryDirectory() as folder:
        jobs = Path(folder, "jobs")
        common = ("--quiet", "--threads", "1")
        costs = {"split_seconds": cpu_seconds(papilla, "split", scene, "-m", materials, "-o", jobs, *common)}
        costs["split_bytes"] = folder_bytes(jobs)
        parts = []
        for line in (jobs / "manifest.jsonl").read_text(encoding="utf-8").splitlines():
            job = json.loads(line)
            seconds = cpu_seconds(papilla, "bake", "--job", jobs / job["id"], *common)
            parts.append({"id": job["id"], "triangles": job["triangles"], "estimate": job["cost_seconds"],
                          "seconds": seconds, "input_bytes": sum(file["bytes"] for file in job["inputs"])})
        costs["jobs_bytes"] = folder_bytes(jobs) - costs["split_bytes"]
        again = sorted(cpu_seconds(papilla, "bake", "--job", jobs / part["id"], *common) for part in parts)
        costs["overhead_seconds"] = again[len(again) // 2]
        output = Path(folder, "scene.glb")
        costs["merge_seconds"] = cpu_seconds(papilla, "merge", jobs, "-o", output, *common)
        costs["output_bytes"] = output.stat().st_size
        return {**costs, "parts": parts}


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    Path(sys.argv[4]).write_text(json.dumps(measure(*sys.argv[1:4]), indent=1) + "\n", encoding="utf-8")
