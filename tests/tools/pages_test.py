"""Pages name what the code has: tables of measurements, and keys of simulations, runs and paths."""

import json
import pathlib
import re
import sys
import tempfile
import unittest

from tool_module import PROJECT

sys.path.insert(0, str(PROJECT / "benchmarks"))
from report import Report  # noqa: E402

DOCS = PROJECT / "docs"


class TablesOfMeasurements(unittest.TestCase):
    """benchmarks/run --update-docs fails at the end of a long run for a table without a place."""

    def setUp(self):
        code = (PROJECT / "benchmarks" / "run").read_text(encoding="utf-8")
        page = re.search(r'PAGE = ROOT / "docs" / "([^"]+)"', code).group(1)
        self.text = (DOCS / page).read_text(encoding="utf-8")
        self.names = set(re.findall(r'report\.table\(\s*"(\w+)"', code))

    def test_have_a_place_each(self):
        places = re.findall(r"<!-- table (\w+) -->", self.text)
        self.assertEqual(sorted(places), sorted(self.names))

    def test_are_written_without_touching_the_rest(self):
        report = Report()
        report.tables = {name: "| new |\n" for name in self.names}
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder, "page.md")
            page.write_text(self.text, encoding="utf-8")
            report.write_into(page)
            written = page.read_text(encoding="utf-8")
        self.assertEqual(written.count("| new |\n"), len(self.names))
        self.assertEqual(re.findall("^#.*$", written, re.MULTILINE), re.findall("^#.*$", self.text, re.MULTILINE))


class KeysOfFiles(unittest.TestCase):
    def schema(self, name):
        file, = (PROJECT / "src" / "firstcontact").glob(f"*/schema/{name}.json")
        return json.loads(file.read_text(encoding="utf-8"))

    def missing(self, definition, page):
        text = (DOCS / page).read_text(encoding="utf-8")
        return {key for key in definition["properties"] if f"`{key}`" not in text}

    def test_of_a_scene_are_explained(self):
        scene = self.schema("scene")
        for definition in (scene["properties"]["simulation"], scene["$defs"]["dynamics"],
                           scene["$defs"]["robot_dynamics"], scene["$defs"]["motor"]):
            self.assertEqual(self.missing(definition, "simulation.md"), set())

    def test_of_a_run_are_explained(self):
        run = self.schema("run")
        for name, definition in run["$defs"].items():
            if "properties" in definition:
                self.assertEqual(self.missing(definition, "run_format.md"), set(), name)

    def test_of_a_path_are_explained(self):
        path = self.schema("path")
        self.assertEqual(self.missing(path, "path_format.md"), set())
        for name, definition in path["$defs"].items():
            if "properties" in definition:
                self.assertEqual(self.missing(definition, "path_format.md"), set(), name)

    def test_of_a_plan_are_explained(self):
        plan = self.schema("scene")["properties"]["plan"]
        self.assertEqual(self.missing(plan, "planning.md"), set())

    def test_of_haptics_are_explained(self):
        haptics = self.schema("scene")["properties"]["haptics"]
        self.assertEqual(self.missing(haptics, "haptics.md"), set())
        self.assertEqual(self.missing(haptics["properties"]["tools"]["items"], "haptics.md"), set())


if __name__ == "__main__":
    unittest.main()
