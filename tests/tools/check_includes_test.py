"""CONTRIBUTING's map of rooms is the table of tools/check_includes, and leads to where a change begins."""

import contextlib
import io
import pathlib
import re
import tempfile
import unittest

from tool_module import PROJECT, load_tool

includes = load_tool("check_includes")
CONTRIBUTING = (PROJECT / "CONTRIBUTING.md").read_text(encoding="utf-8")
ROOMS = PROJECT / "src" / "firstcontact"

# The questions that a newcomer asks, with the room of the answer.
CHANGES = {
    "a new mesh format": "mesh_files",
    "a new joint type": "robot",
    "a new in-between motion": "motion",
    "another restitution law": "island",
    "a new key of a scene": "scene_files",
    "a new panel of the page": "viewer",
    "a tighter bound of two boxes": "narrowphase",
    "another option of `check`": "apps",
}


def output_of(call) -> tuple:
    """What a function returns, and prints."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        status = call()
    return status, text.getvalue()


def rows_below(heading: str) -> list:
    """The cells of each row of the first table that has these column titles."""
    lines = CONTRIBUTING[CONTRIBUTING.index(heading):].split("\n\n")[0].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def quoted(cell: str) -> list:
    return re.findall(r"`([^`]+)`", cell)


class Map(unittest.TestCase):
    def test_is_the_table_of_rooms(self):
        _, table = output_of(includes.show_map)
        self.assertIn(f"<!-- map of tools/check_includes --map -->\n{table}<!-- end -->\n", CONTRIBUTING)

    def test_has_every_room_and_no_other(self):
        folders = {path.name for path in ROOMS.iterdir() if path.is_dir()}
        rooms = {name for row in rows_below("| room | holds | may include |") for name in quoted(row[0])}
        self.assertEqual(rooms - folders, set())
        # What is no room has no sources.
        self.assertEqual({name for name in folders - rooms if includes.files_of(ROOMS / name)}, set())


class Names(unittest.TestCase):
    def complaints(self, *texts) -> list:
        with tempfile.TemporaryDirectory() as folder:
            for number, text in enumerate(texts):
                pathlib.Path(folder, f"{number}.h").write_text(text, encoding="utf-8")
            return list(includes.complaints_of_names(pathlib.Path(folder)))

    def test_are_those_of_one_header_each(self):
        self.assertEqual(
            self.complaints("namespace a {\nclass Found : public B {\n};\n}\n", "namespace a {\nstruct Found {\n};\n}\n"),
            ["1.h: a::Found is a name of 0.h, too"])

    def test_may_be_declared_again_and_be_those_of_another_namespace(self):
        self.assertEqual(
            self.complaints("namespace a {\nclass Found {\n};\n}\n", "namespace a {\nclass Found;\n}\n",
                            "namespace b {\nclass Found {\n};\n}\n"), [])


class Changes(unittest.TestCase):
    def setUp(self):
        self.rows = {row[0]: row[1:] for row in rows_below("| change | room | begin in | tests |")}

    def test_are_those_that_are_asked(self):
        self.assertEqual(list(self.rows), list(CHANGES))
        for change, room in CHANGES.items():
            self.assertEqual(quoted(self.rows[change][0])[0], room)

    def test_have_rooms_that_the_map_shows(self):
        for change, (rooms, _, _) in self.rows.items():
            for room in quoted(rooms):
                beside = f"`{room}/`" in CONTRIBUTING  # The sentence below the map.
                self.assertTrue(room in includes.ROOMS or beside, (change, room))

    def test_begin_and_are_tested_in_paths_that_exist(self):
        for change, (rooms, begin, tests) in self.rows.items():
            room = quoted(rooms)[0]
            paths = [path for path in quoted(begin) if "/" in path]
            self.assertTrue(paths, change)
            for path in (*paths, *quoted(tests)):
                self.assertTrue((PROJECT / path).exists(), (change, path))
            self.assertIn(room, pathlib.PurePath(paths[0]).parts, change)
            self.assertIn(room, pathlib.PurePath(quoted(tests)[0]).parts, change)

    def test_begin_at_names_that_are_there(self):
        for change, (_, begin, _) in self.rows.items():
            paths = [PROJECT / path for path in quoted(begin) if "/" in path]
            for name in (name for name in quoted(begin) if "/" not in name):
                texts = [path.read_text(encoding="utf-8") for path in paths if path.is_file()]
                self.assertTrue(any(re.search(rf"\b{re.escape(name)}\b", text) for text in texts), (change, name))


class Figures(unittest.TestCase):
    def test_are_within_their_limits(self):
        status, text = output_of(includes.figures)
        self.assertEqual(status, 0, text)

    def test_are_past_them_where_a_file_or_function_is_long(self):
        self.assertEqual(list(includes.functions_in("int f(int a) {\n  return a;\n}\n")), [(1, 3)])
        long = "void f() {\n" + "  g();\n" * 80 + "}\n"
        ((line, length),) = includes.functions_in("// One.\n" + long)
        self.assertEqual((line, length), (2, 82))
        self.assertGreater(length, includes.LINES_OF_FUNCTION)

    def test_name_a_circle(self):
        graph = includes.Graph({"a.h": ["b.h"], "b.h": ["c.h"], "c.h": ["b.h"]})
        with self.assertRaisesRegex(ValueError, "b.h -> c.h -> b.h"):
            graph.chain("a.h")

    def test_count_the_longest_way_down(self):
        graph = includes.Graph({"a.h": ["b.h", "c.h"], "b.h": ["c.h"], "c.h": []})
        self.assertEqual(graph.chain("a.h"), ("a.h", "b.h", "c.h"))
        self.assertEqual(graph.all_below("a.h"), {"b.h", "c.h"})


class Includes(unittest.TestCase):
    def complaints(self, room: str, *lines: str) -> list:
        """Of a file of that room in a tree of its own."""
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder)
            for path in ("geometry/mesh.h", "query/distance.h", "query/detail/order.h"):
                (source / "firstcontact" / path).parent.mkdir(parents=True, exist_ok=True)
                (source / "firstcontact" / path).touch()
            file = source / "firstcontact" / room / "file.cpp"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("\n".join(lines) + "\n", encoding="utf-8")
            before = includes.SOURCE
            includes.SOURCE = source
            try:
                return [complaint for _, complaint in includes.complaints(file)]
            finally:
                includes.SOURCE = before

    def test_go_down_only(self):
        self.assertEqual(self.complaints("query", "#include <firstcontact/geometry/mesh.h>"), [])
        self.assertEqual(self.complaints("geometry", "#include <firstcontact/query/distance.h>"),
                         ["'geometry' must not include 'query' (<firstcontact/query/distance.h>)"])
        self.assertEqual(self.complaints("scene", "#include <firstcontact/query/detail/order.h>"), [])

    def test_are_in_the_table_and_exist(self):
        self.assertEqual(len(self.complaints("attic", "#include <vector>")), 1)
        self.assertEqual(self.complaints("query", "#include <firstcontact/query/none.h>"),
                         ["<firstcontact/query/none.h> does not exist"])
        self.assertEqual(len(self.complaints("query", '#include "order.h"')), 1)

    def test_of_adapters_are_installed(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "space.h").write_text("#include <firstcontact/query/detail/pair_query.h>\n"
                                                       "#include <firstcontact/query/shape_pair.h>\n",
                                                       encoding="utf-8")
            before = includes.ADAPTERS
            includes.ADAPTERS = pathlib.Path(folder)
            try:
                found = list(includes.complaints_of_installed())
            finally:
                includes.ADAPTERS = before
        self.assertIn("<firstcontact/query/detail/pair_query.h> is of a detail/ folder, but a header that is "
                      "installed includes it", found)
        self.assertIn("<firstcontact/query/shape_pair.h> is included by a header that is installed: "
                      "add it to supporting_headers", found)

    def test_keep_the_proof_apart_from_what_it_proves(self):
        for room in ("contact_solver", "simulation", "query", "narrowphase", "robot_check"):
            self.assertNotIn(room, includes.reach("verification"))


if __name__ == "__main__":
    unittest.main()
