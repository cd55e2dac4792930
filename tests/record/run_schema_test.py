"""The lines of runs are what their schema says, and the schema says something.

    run_schema_test.py SCHEMA CORPUS

Every line of CORPUS that is whole is one that the reader reads. Exit status 77: python3-jsonschema
is not installed.
"""

import copy
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: needs the Debian package python3-jsonschema")
    sys.exit(77)


# Keys that a line may lack.
OPTIONAL = ("kind", "devices")


def spoiled(value):
    """Copies of a line that lack a key somewhere, or have one too many, or a row of another length."""
    if isinstance(value, dict):
        yield {**value, "extra": 1}
        for key, member in value.items():
            if key not in OPTIONAL:
                yield {other: kept for other, kept in value.items() if other != key}
            if key != "scene":
                yield from ({**value, key: wrong} for wrong in spoiled(member))
    elif isinstance(value, list) and value:
        if isinstance(value[0], dict):
            yield from ([wrong, *value[1:]] for wrong in spoiled(value[0]))
        elif len(value) in (2, 3, 4, 14):
            yield [*value, 0.0]


def main(schema_path: str, corpus: str) -> int:
    schema = json.loads(pathlib.Path(schema_path).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    complaints = []
    lines = 0
    for run in sorted(pathlib.Path(corpus).glob("*.jsonl")):
        for number, text in enumerate(run.read_text(encoding="utf-8").split("\n")[:-1], start=1):
            line = json.loads(text)
            lines += 1
            place = f"{run.name}:{number}"
            complaints += [f"{place}: {error.message}" for error in validator.iter_errors(line)]
            for wrong in spoiled(copy.deepcopy(line)):
                if "masses" in line and wrong.keys() == line.keys() and wrong["masses"] != line["masses"]:
                    continue  # There are as many as bodies, which a schema cannot count.
                if validator.is_valid(wrong):
                    complaints.append(f"{place}: accepted though spoiled: {json.dumps(wrong)[:300]}")
    if lines < 5:
        complaints.append(f"only {lines} lines in {corpus}")
    print("\n".join(complaints) or f"{lines} lines are as the schema says")
    return 1 if complaints else 0


sys.exit(main(*sys.argv[1:]))
