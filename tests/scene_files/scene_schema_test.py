"""The schema tells good scenes from bad ones, as far as a schema can.

    scene_schema_test.py SCHEMA CORPUS

CORPUS has the folders good/, bad/ (the schema refuses them) and inconsistent/ (only the reader
refuses them). Exit status 77: python3-jsonschema is not installed.
"""

import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: needs the Debian package python3-jsonschema")
    sys.exit(77)


def main(schema_path: str, corpus: str) -> int:
    schema = json.loads(pathlib.Path(schema_path).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    expected = {"good": True, "inconsistent": True, "bad": False}
    wrong = 0
    for folder, valid in expected.items():
        scenes = sorted(pathlib.Path(corpus, folder).glob("*.json"))
        if not scenes:
            print(f"no scenes in {folder}/")
            wrong += 1
        for scene in scenes:
            error = jsonschema.exceptions.best_match(
                validator.iter_errors(json.loads(scene.read_text(encoding="utf-8"))))
            if (error is None) != valid:
                print(f"{folder}/{scene.name}: {error.message if error else 'accepted'}")
                wrong += 1
    return 1 if wrong else 0


sys.exit(main(*sys.argv[1:]))
