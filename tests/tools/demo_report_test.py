"""demo/report.py makes a card of each scene, path, simulation and haptic session that there is, and of nothing else."""

import contextlib
import html.parser
import io
import json
import pathlib
import tempfile
import unittest

from tool_module import load_tool

report = load_tool("../demo/report.py")

FREE = {"id": "apart <b>", "verdict": "free", "time": 1.0, "pair": None, "contacts": [], "clearance": 0.0025,
        "pair_counts": {"tested": 3}, "warnings": ["one", "two"]}
CONTACT = {"id": "hit", "verdict": "contact", "time": 0.123456, "pair": ["a & b", "c"], "contacts": [],
           "clearance": 0.0, "pair_counts": {"tested": 1}}


PATH = {"moves": {"body": "a cart"}, "edges": [{}, {}], "clearance": 0.25}


class Cards(html.parser.HTMLParser):
    """The text of each card, by its name, and what it links to."""

    def __init__(self, page: str):
        super().__init__()
        self.texts = {}
        self.links = {}
        self.kinds = {}
        self.name = None
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if tag == "article":
            self.name = given["id"]
            self.texts[self.name], self.links[self.name] = "", []
            self.kinds[self.name] = given["data-kind"]
        elif tag == "a" and self.name:
            self.links[self.name].append(given["href"])

    def handle_endtag(self, tag):
        if tag == "article":
            self.name = None

    def handle_data(self, data):
        if self.name:
            self.texts[self.name] += data


class Report(unittest.TestCase):
    def cards(self, verified=True):
        with tempfile.TemporaryDirectory() as path:
            folder = pathlib.Path(path)
            for name, result in (("free", FREE), ("contact", CONTACT)):
                (folder / f"{name}.json").write_text(json.dumps(result), encoding="utf-8")
                (folder / f"{name}.txt").write_text(f"said of {name} <i>", encoding="utf-8")
            for played in ("free.html", "free.svg", "run.html"):
                (folder / played).write_text("", encoding="utf-8")
            lines = [{"scene": {"id": "a run"}}, {"time": 0.5}, {"time": 1.0}]
            (folder / "run.jsonl").write_text("\n".join(map(json.dumps, lines)) + "\n", encoding="utf-8")
            proof = "run.jsonl: proven: none touches\n" if verified else "error: no proof\n"
            (folder / "run.txt").write_text("  tested     28 pairs\n" + proof, encoding="utf-8")
            (folder / "path.json").write_text(json.dumps(PATH), encoding="utf-8")
            proof = "path.json: proven: 2 edges\n" if verified else "error: no proof\n"
            (folder / "path.txt").write_text(proof + "  tested     4 pairs\n", encoding="utf-8")
            (folder / "felt.jsonl").write_text("\n".join(map(json.dumps, lines)) + "\n", encoding="utf-8")
            proof = "felt.jsonl: proven: none touches\n" if verified else "error: no proof\n"
            (folder / "felt.txt").write_text("  force      at most 1.5 N and 0.2 N m\n" + proof, encoding="utf-8")
            (folder / "felt.svg").write_text("", encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()) as said:
                report.main(folder, ["free", "contact", "missing"], ["run", "missing_run"], ["path", "missing_path"],
                            ["felt", "missing_session"])
            return Cards((folder / "index.html").read_text(encoding="utf-8")), said.getvalue()

    def test_has_what_there_is_and_nothing_else(self):
        cards, said = self.cards()
        self.assertEqual(list(cards.texts), ["free", "contact", "path", "felt", "run"])
        self.assertIn("apart <b>", said)

    def test_says_the_verdict_the_pairs_and_the_warnings(self):
        cards, _ = self.cards()
        for text in ("apart <b>", "Free", "apart by > 2.5 mm", "3 pairs tested", "2 warnings", "said of free <i>"):
            self.assertIn(text, cards.texts["free"])
        for text in ("Contact", "a & b and c at 0.1235 s", "1 pair tested"):
            self.assertIn(text, cards.texts["contact"])
        self.assertNotIn("warning", cards.texts["contact"])
        self.assertEqual([cards.kinds[name] for name in ("free", "contact")], ["free", "contact"])

    def test_links_to_what_there_is(self):
        cards, _ = self.cards()
        self.assertEqual(set(cards.links["free"]), {"free.html", "free.svg", "free.json"})
        self.assertEqual(cards.links["contact"], ["contact.json"])
        self.assertEqual(set(cards.links["run"]), {"run.html", "run.jsonl"})

    def test_names_all_that_moves_in_a_path(self):
        for moves, title in (({"robot": "arm"}, "arm"), ({"robots": ["left", "right"]}, "left and right")):
            facts = report.of_plan("path", {**PATH, "moves": moves}, "")
            self.assertEqual(facts["title"], f"A path of {title}")

    def test_calls_a_path_verified_only_where_it_is(self):
        cards, _ = self.cards()
        for text in ("A path of a cart", "Planned, verified", "2 edges, apart by > 250 mm", "4 pairs tested"):
            self.assertIn(text, cards.texts["path"])
        cards, _ = self.cards(verified=False)
        self.assertNotIn("verified", cards.texts["path"])

    def test_calls_a_path_proven_where_only_its_planner_proved_it(self):
        facts = report.of_plan("path", PATH, "nut.json: a path to the goal, proven edge by edge\n")
        self.assertEqual((facts["word"], facts["kind"]), ("Planned, proven", "free"))
        text = "nut.json: a path to the goal, proven edge by edge\npath.json: not proven\n"
        facts = report.of_plan("path", PATH, text)
        self.assertEqual((facts["word"], facts["kind"]), ("Planned", "undecided"))
        facts = report.of_plan("path", PATH, "nut.json: an approximate path, proven edge by edge\n")
        self.assertEqual((facts["word"], facts["kind"]), ("Planned", "undecided"))

    def test_shows_the_force_of_a_haptic_session(self):
        cards, _ = self.cards()
        for text in ("Felt, verified", "2 steps, 1 s, at most 1.5 N", "Forces over time"):
            self.assertIn(text, cards.texts["felt"])
        self.assertEqual(set(cards.links["felt"]), {"felt.svg", "felt.jsonl"})
        cards, _ = self.cards(verified=False)
        self.assertNotIn("verified", cards.texts["felt"])

    def test_calls_a_simulation_verified_only_where_it_is(self):
        cards, _ = self.cards()
        self.assertIn("Simulated, verified", cards.texts["run"])
        for text in ("2 steps, 1 s", "28 pairs tested"):
            self.assertIn(text, cards.texts["run"])
        cards, _ = self.cards(verified=False)
        self.assertNotIn("verified", cards.texts["run"])
        self.assertEqual(cards.kinds["run"], "undecided")


if __name__ == "__main__":
    unittest.main()
