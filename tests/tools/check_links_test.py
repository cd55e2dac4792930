"""tools/check_links finds links that lead nowhere, and no others."""

import pathlib
import tempfile
import unittest

from tool_module import load_tool

links = load_tool("check_links")

OTHER = "# The other\n\n## `keep_half`, and (more) of it\n\n## At last {#end}\n\n```\n# no heading\n```\n"


class Links(unittest.TestCase):
    def of(self, text, place="README.md"):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs" / "site").mkdir(parents=True)
            (root / "docs" / "other.md").write_text(OTHER, encoding="utf-8")
            page = root / place
            page.write_text(text, encoding="utf-8")
            return [line for line, _ in links.complaints(root, page)]

    def test_to_files_and_headings_are_found(self):
        self.assertEqual(self.of("[a](docs/other.md) [b](docs/other.md#the-other) [c](https://no.where/x.md)"), [])
        self.assertEqual(self.of("[a](docs/other.md#keep_half-and-more-of-it) [b](docs/other.md#end)"), [])
        self.assertEqual(self.of("# Here\n[a](#here)"), [])

    def test_to_nowhere_are_named(self):
        self.assertEqual(self.of("x\n[a](docs/none.md)"), [2])
        self.assertEqual(self.of("[a](docs/other.md#none)\n[b](docs/other.md#no-heading)\n[c](#there)"), [1, 2, 3])
        self.assertEqual(self.of('<img src="none.svg">'), [1])

    def test_in_code_are_none(self):
        self.assertEqual(self.of("`[a](none.md)`\n```\n[a](none.md)\n```"), [])

    def test_of_the_site_are_read_as_the_site_has_them(self):
        self.assertEqual(self.of("[a](other.md) [b](scene-reference.md) [c](cpp/index.html)", "docs/site/index.md"), [])


class Navigation(unittest.TestCase):
    def of(self, entries, pages):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs" / "site").mkdir(parents=True)
            for page in pages:
                (root / "docs" / page).write_text("# Page\n", encoding="utf-8")
            text = "nav:\n" + "".join(f"      - Title: {entry}\n" for entry in entries)
            (root / "docs" / "site" / "mkdocs.yml").write_text(text, encoding="utf-8")
            return [line for line, _ in links.about_navigation(root)]

    def test_lists_every_page(self):
        entries = ["a.md", "site.md", "scene-reference.md", "CHANGELOG.md"]
        self.assertEqual(self.of(entries, ["a.md", "site/site.md"]), [])
        self.assertEqual(self.of(["a.md"], ["a.md", "b.md"]), [2])

    def test_lists_no_others(self):
        self.assertEqual(self.of(["a.md", "none.md"], ["a.md"]), [3])


class Paths(unittest.TestCase):
    def of(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("src/firstcontact/math/interval.h", "tests/support/oracle.h"):
                (root / name).parent.mkdir(parents=True)
                (root / name).touch()
            page = root / "README.md"
            page.write_text(text, encoding="utf-8")
            return [line for line, _ in links.about_paths(root, page)]

    def test_of_sources_are_below_the_root_or_the_library(self):
        for name in ("src/firstcontact/math/interval.h", "firstcontact/math/interval.h", "math/interval.h",
                     "tests/support/oracle.h", "tests/support", "interval.h", "a/b.json", "GROUP/NAME"):
            self.assertEqual(self.of(f"A file `{name}`"), [], name)

    def test_that_are_gone_are_named(self):
        self.assertEqual(self.of("x\n`text/interval.h`\n`tests/query`"), [2, 3])


class Headers(unittest.TestCase):
    def of(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for path in ("src/firstcontact", "adapters/ompl/firstcontact_ompl"):
                (root / path).mkdir(parents=True)
            (root / "src/firstcontact/public_headers.cmake").write_text(
                "set(public_headers\n  firstcontact/query/distance.h)\n", encoding="utf-8")
            (root / "adapters/ompl/firstcontact_ompl/space.h").touch()
            page = root / "README.md"
            page.write_text(text, encoding="utf-8")
            return [line for line, _ in links.about_headers(page, links.installed_headers(root))]

    def test_that_are_installed_or_in_the_repository_are_fine(self):
        self.assertEqual(self.of("`firstcontact/query/distance.h` `src/firstcontact/query/detail/order.h`\n"
                                 "```cpp\n#include <firstcontact_ompl/space.h>\n```\n"), [])

    def test_that_are_not_installed_are_named(self):
        self.assertEqual(self.of("`firstcontact/query/none.h`\n\n```cpp\n#include <firstcontact_ompl/none.h>\n```\n"),
                         [1, 4])


class Rooms(unittest.TestCase):
    def of(self, rooms):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "src" / "firstcontact").mkdir(parents=True)
            headers = "set(public_headers\n  firstcontact/math/interval.h\n  firstcontact/query/distance.h)\n"
            (root / "src" / "firstcontact" / "public_headers.cmake").write_text(headers, encoding="utf-8")
            (root / "docs" / "site").mkdir(parents=True)
            text = "# C++\n" + "".join(f"- `firstcontact/{room}/`: it\n" for room in rooms)
            (root / "docs" / "site" / "cpp.md").write_text(text, encoding="utf-8")
            return [line for line, _ in links.about_rooms(root)]

    def test_with_public_headers_are_those_of_the_page(self):
        self.assertEqual(self.of(["math", "query"]), [])
        self.assertEqual(self.of(["math"]), [2])
        self.assertEqual(self.of(["math", "scene", "query"]), [3])


if __name__ == "__main__":
    unittest.main()
