"""What the tool writes is what the schema of results says, and the schema says something.

    result_schema_test.py TOOL SOURCE_DIR

Exit status 77: python3-jsonschema is not installed.
"""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile

import scenes

try:
    import jsonschema
except ImportError:
    print("skipped: needs the Debian package python3-jsonschema")
    sys.exit(77)


def results(tool: str, files: list, *more: str) -> list:
    """Of all scenes of the files, with all that can be asked."""
    run = subprocess.run([tool, "check", "--json", "--all-pairs", "--closest", *more, *files],
                         capture_output=True, text=True, timeout=200, check=False)
    return [json.loads(line) for line in run.stdout.splitlines()]


def spoiled(result: dict) -> list:
    """Results that the schema must refuse: each lacks a key, or has a wrong one."""
    wrong = [{**result, "extra": 1}]
    for key in result:
        if key not in ("closest", "pairs", "sampling", "tolerance_used", "enclosure_error", "line", "limits",
                       "turns", "warnings", "contact_count_is_least", "scene_digest", "resolved_digest"):
            less = copy.deepcopy(result)
            del less[key]
            wrong.append(less)
    if "t" in result:
        wrong += [{**result, "t": 1.5}, {**result, "verdict": "maybe"}, {**result, "input_digest": "x"},
                  {**result, "scene_digest": "x"}, {**result, "resolved_digest": ""}]
    return wrong


def main(tool: str, source: pathlib.Path) -> int:
    schemas = source / "src/firstcontact/scene_files/schema"
    schema = json.loads((schemas / "result.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    of_results = jsonschema.Draft202012Validator(schema)
    of_scenes = jsonschema.Draft202012Validator(json.loads((schemas / "scene.json").read_text(encoding="utf-8")))
    with tempfile.TemporaryDirectory() as folder:
        lines = pathlib.Path(folder, "scenes.jsonl")
        lines.write_text("\n".join([scenes.CONTACT, scenes.AT_START, scenes.FREE, scenes.UNDECIDED, scenes.BAD]),
                         encoding="utf-8")
        good = sorted(map(str, (source / "tests/fuzz/corpus/fuzz_scene/good").glob("*.json")))
        with_robots = [scene for scene in good if '"robots"' in pathlib.Path(scene).read_text(encoding="utf-8")]
        good = [scene for scene in good if scene not in with_robots]
        found = results(tool, [str(lines), *good], "--sample-rate", "20")
        of_robots = results(tool, with_robots, "--all-contacts-in-time")
    complaints = []
    if len(found) != 5 + len(good):
        complaints.append(f"{len(found)} results of {5 + len(good)} scenes")
    if not of_robots or any("error" in result or not result["warnings"] for result in of_robots):
        complaints.append("no results with robots and warnings")
    for result in found + of_robots:
        name = result.get("id") or result.get("error")
        complaints += [f"{name}: {error.message}" for error in of_results.iter_errors(result)]
        if "scene" in result:
            complaints += [f"{name}: scene: {error.message}" for error in of_scenes.iter_errors(result["scene"])]
        complaints += [f"{name}: accepted though spoiled" for wrong in spoiled(result) if of_results.is_valid(wrong)]
    print("\n".join(complaints) or f"{len(found)} results are as the schema says")
    return 1 if complaints else 0


sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2])))
