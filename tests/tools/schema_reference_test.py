"""tools/schema_reference leaves no key of a schema out, and keeps the tables in pages as the schemas are."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from tool_module import PROJECT, load_tool

reference = load_tool("schema_reference")


def keys(value):
    """Every name of a property anywhere in a schema."""
    if isinstance(value, list):
        return set().union(*map(keys, value))
    if not isinstance(value, dict):
        return set()
    properties = value.get("properties")
    found = set(properties) if isinstance(properties, dict) else set()
    return found.union(*map(keys, value.values()))


class Reference(unittest.TestCase):
    def test_names_every_key(self):
        for name in ("scene", "result", "run"):
            schema = reference.schema_of(name)
            page = reference.Page(schema).write()
            missing = {key for key in keys(schema) if f"`{key}`" not in page and f".{key}`" not in page}
            self.assertEqual(missing, set(), name)

    def test_takes_the_description_of_a_definition_where_a_key_has_none(self):
        schema = {"$defs": {"end": {"type": "object", "description": "The last."}}, "properties": {
            "end": {"$ref": "#/$defs/end"}}, "title": "T"}
        row = next(line for line in reference.Page(schema).write().split("\n") if "`end`" in line)
        self.assertIn("The last.", row)


class Tables(unittest.TestCase):
    def run_on(self, option, page):
        return subprocess.run([sys.executable, PROJECT / "tools" / "schema_reference", option, page],
                              capture_output=True, encoding="utf-8", check=False)

    def test_are_filled_once_and_checked(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder, "page.md")
            page.write_text("Before.\n<!-- keys: scene options -->\nstale text\n<!-- end of keys -->\nBehind.\n")
            self.assertEqual(self.run_on("--check", page).returncode, 1)
            self.assertEqual(self.run_on("--fill", page).returncode, 0)
            text = page.read_text(encoding="utf-8")
            self.assertIn("| `tolerance` | number > 0 |", text)
            self.assertNotIn("stale text", text)
            self.assertTrue(text.startswith("Before.\n") and text.endswith("\nBehind.\n"))
            self.assertEqual(self.run_on("--fill", page).returncode, 0)
            self.assertEqual(page.read_text(encoding="utf-8"), text)
            self.assertEqual(self.run_on("--check", page).returncode, 0)


if __name__ == "__main__":
    unittest.main()
