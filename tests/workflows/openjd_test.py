# SPDX-License-Identifier: GPL-3.0-or-later
"""workflows/openjd/template.yaml: its steps are resolved as Open Job Description 2023-09 says and run on this machine; the
merged bytes are those of the whole bake. openjd_test.py PAPILLA SOURCE_FOLDER"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import yaml
except ImportError:
    print("skipped: python3-yaml is not installed")
    sys.exit(77)

papilla, source = sys.argv[1], Path(sys.argv[2])
template = yaml.safe_load((source / "workflows/openjd/template.yaml").read_text(encoding="utf-8"))


def only(value, allowed, where):
    unknown = set(value) - set(allowed.split())
    assert not unknown, f"{where}: {unknown} is not of 2023-09"


def resolve(text, symbols):
    """Format strings, section 7.3: a name that is not defined is an error."""
    return re.sub(r"\{\{\s*([A-Za-z_][\w.]*)\s*\}\}", lambda name: str(symbols[name[1]]), text)


def int_range(text):
    """A range expression of one range, section 3.4.1.1: start-end:step."""
    start, end, step = map(int, re.fullmatch(r"(\d+)-(\d+)(?::(\d+))?", text).groups("1"))
    return range(start, end + 1, step)


def tasks(step, symbols):
    if "parameterSpace" not in step:
        return [{}]
    (parameter,) = step["parameterSpace"]["taskParameterDefinitions"]
    only(parameter, "name type range", step["name"])
    assert parameter["type"] == "INT"
    return [{f"Task.Param.{parameter['name']}": value} for value in int_range(resolve(parameter["range"], symbols))]


def run_task(step, symbols, folder):
    symbols = dict(symbols)
    for file in step["script"].get("embeddedFiles", []):
        only(file, "name type filename runnable data", step["name"])
        path = folder / file["filename"]
        path.write_text(resolve(file["data"], symbols), encoding="utf-8")
        symbols[f"Task.File.{file['name']}"] = path
    action = step["script"]["actions"]["onRun"]
    only(action, "command args timeout cancelation", step["name"])
    subprocess.run([resolve(word, symbols) for word in [action["command"], *action.get("args", [])]], check=True,
                   stdout=subprocess.DEVNULL)


def parameters(given):
    symbols = {}
    for definition in template["parameterDefinitions"]:
        only(definition, "name type description default objectType dataFlow minValue maxValue userInterface", definition["name"])
        assert definition["type"] in ("STRING", "PATH", "INT", "FLOAT")
        value = given.pop(definition["name"], definition.get("default"))
        assert value is not None, f"{definition['name']} has no value"
        assert value >= definition["minValue"] if "minValue" in definition else True
        symbols[f"Param.{definition['name']}"] = value
    assert not given, f"the template does not know {given}"
    return symbols


only(template, "specificationVersion name description parameterDefinitions jobEnvironments steps", "template")
assert template["specificationVersion"] == "jobtemplate-2023-09"
for number, step in enumerate(template["steps"]):
    only(step, "name description dependencies stepEnvironments hostRequirements parameterSpace script", "step")
    earlier = {other["name"] for other in template["steps"][:number]}
    assert step["name"] not in earlier and len(step["name"]) <= 64
    assert {need["dependsOn"] for need in step.get("dependencies", [])} == earlier, "each step waits for those before it"

with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    jobs, merged, whole = folder / "the jobs", folder / "merged.glb", folder / "whole.glb"
    shape = [source / "data/cockpit.step", "-m", source / "tests/workflows/materials.json", "--chord", "1", "--quiet"]
    subprocess.run([papilla, "split", *shape, "-o", jobs], check=True)
    subprocess.run([papilla, "bake", *shape, "-o", whole, "--cache", "none"], check=True)
    count = len((jobs / "manifest.jsonl").read_text(encoding="utf-8").splitlines())
    symbols = parameters({"JobsFolder": jobs, "JobCount": count, "JobsPerTask": 10, "Output": merged, "Papilla": papilla})
    assert len(resolve(template["name"], symbols)) <= 128
    for step in template["steps"]:
        found = tasks(step, symbols)
        assert len(found) == (-(-count // 10) if step["name"] == "Bake" else 1), step["name"]
        for task in found:
            run_task(step, symbols | task, folder)
    assert merged.read_bytes() == whole.read_bytes(), "other bytes than the whole bake"
print(f"{count} jobs, same bytes")
