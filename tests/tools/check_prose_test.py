"""tools/check_prose finds what the language section of CONTRIBUTING does not want, and nothing else."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from tool_module import PROJECT, load_tool

prose = load_tool("check_prose")


def of_page(text):
    return [(line, wrong) for _, line, wrong in prose.of_page("page.md", text.splitlines())]


def sentence(count):
    return " ".join(["so"] * count) + "."


class Sentences(unittest.TestCase):
    def test_of_25_words_are_taken_and_of_26_are_not(self):
        self.assertEqual(of_page(sentence(25)), [])
        self.assertEqual([line for line, _ in of_page("Short.\n" + sentence(26))], [2])

    def test_begin_where_they_begin_although_lines_do_not(self):
        found = of_page("One.\nTwo. Three\n" + "four\n" * 26)
        self.assertEqual([line for line, _ in found], [2])

    def test_of_two_items_or_paragraphs_are_two(self):
        half = "so " * 15
        for text in (f"- {half}\n- {half}", f"{half}\n\n{half}", f"1. {half}\n2. {half}", f"# {half}\n{half}"):
            self.assertEqual(of_page(text.replace(" \n", "\n")), [], text)

    def test_do_not_end_at_abbreviations_and_initials(self):
        for mark in ("e.g.", "T. J.", "et al."):
            self.assertEqual(len(of_page(f"{'so ' * 13}{mark} {'so ' * 13}.")), 1, mark)

    def test_end_at_letters_of_formulas(self):
        self.assertEqual(of_page(f"{'so ' * 13} is in Q. {'So ' * 13}."), [])
        self.assertEqual(len(of_page(f"{'so ' * 13} by Q. {'So ' * 13}.")), 1)

    def test_count_code_formulas_and_targets_of_links_little(self):
        self.assertEqual(of_page("so " * 24 + "`a b c d`."), [])
        self.assertEqual(of_page("so " * 24 + "a = b + c − d."), [])
        self.assertEqual(of_page("so " * 23 + "[to there](a-b-c.md#d-e)."), [])
        self.assertEqual(len(of_page("so " * 24 + "[to there](a.md).")), 1)

    def test_open_with_a_subject(self):
        self.assertEqual(len(of_page("Of two the first.")), 1)
        self.assertEqual(len(of_page("It is so. What moves is listed.")), 1)
        self.assertEqual(len(of_page("**Who looks** sees it.")), 1)
        self.assertEqual(of_page("It is so. **[What is proven](a.md)** is a title."), [])
        self.assertEqual(of_page("What moves? Offers of two. Whatever moves is listed."), [])


class Left_out(unittest.TestCase):
    def test_is_code_and_its_width(self):
        long = "Of " + "so " * 40
        for text in (f"```\n{long}\n```", f"~~~~\n```\n{long}\n~~~~", f"Text:\n\n    {long}\n    {long}",
                     f"---\ntitle: {long}\n---\nText.", f"<!-- {long}\n{long} -->"):
            self.assertEqual(of_page(text), [], text)

    def test_ends_with_the_code(self):
        self.assertEqual([line for line, _ in of_page("```\nx\n```\nOf two.")], [4])
        self.assertEqual([line for line, _ in of_page("- item\n\n    Of its own.")], [3])

    def test_is_a_table_but_not_the_words_that_stop(self):
        self.assertEqual(of_page("| a | b |\n|---|---|\n| of | " + "so " * 40 + "|"), [])
        self.assertEqual([line for line, _ in of_page("| a |\n|---|\n| hardly |")], [3])


class Lines(unittest.TestCase):
    def test_have_100_columns(self):
        wide = ("abcdefghi " * 10)[:100]
        self.assertEqual(of_page(wide.rstrip() + "i"), [])
        self.assertEqual(len(of_page(wide + "jk")), 1)

    def test_may_be_wider_where_they_cannot_be_broken(self):
        self.assertEqual(of_page("- [link](" + "x" * 120 + ")"), [])
        self.assertEqual(of_page("![A picture of it](" + "x" * 120 + "){ width=300 }"), [])
        self.assertEqual(len(of_page("Text [link](" + "x" * 120 + ")")), 1)


class Phrases(unittest.TestCase):
    def test_are_found_in_any_capitals_and_across_lines(self):
        self.assertEqual([line for line, _ in of_page("It\nmoves.\nHardly by\nfar.")], [3, 3])

    def test_are_whole_words_outside_of_code(self):
        self.assertEqual(of_page("By farms, `hardly`, [essays](says.md)."), [])


class Help_texts(unittest.TestCase):
    def of(self, code):
        return [line for _, line, _ in prose.of_help_texts("command.cpp", code.splitlines())]

    def test_are_read_of_options_and_subcommands(self):
        self.assertEqual(self.of('f("Of no option");\n command.add_flag("--x", x,\n "Of \\"two\\" "\n "words");'), [3])
        self.assertEqual(self.of('CLI::App* c = app.add_subcommand(\n "check", "What it is");'), [2])
        self.assertEqual(self.of('add_number(c, "--x", x, Range::positive, "Hardly (so) any");'), [1])

    def test_end_with_the_call(self):
        self.assertEqual(self.of('c.add_flag("--x", x, "Takes (all) of it");\n throw error("Of no option");'), [])

    def test_of_footers_leave_commands_out(self):
        footer = 'constexpr const char* kFooter = R"(\nFirst:  of all this\n\nOf two words.)";'
        self.assertEqual(self.of(footer), [1])


class Docstrings(unittest.TestCase):
    def of(self, code):
        return [line for _, line, _ in prose.of_docstrings("header.h", code.splitlines())]

    def test_are_read_up_to_their_first_sentence(self):
        self.assertEqual(self.of("/// @file\n/// Of two.\n\n/// It is. Of two.\n/// Of three.\nint x;\n"), [2])
        self.assertEqual(self.of("/// Finds it\n///\n/// Of two.\n"), [])
        self.assertEqual(self.of(f"/// {sentence(26)}\n"), [1])

    def test_say_what_a_thing_is(self):
        text = "/// None for the root.\n\n/// [byte]\n\n/// [m] The length.\n\n/// The link.\n"
        self.assertEqual(self.of(text), [1, 3])

    def test_are_neither_comments_nor_of_members_behind_them(self):
        self.assertEqual(self.of("// Of two.\nint x;  ///< Of two.\n///< Of two.\n"), [])


class Numbers(unittest.TestCase):
    complaint = prose.Complaint("a.md", 3, "wrong")

    def test_that_are_allowed_pass(self):
        self.assertEqual(prose.judge({"a.md": [self.complaint], "b.md": []}, {"a.md": 1}), [])

    def test_that_are_greater_or_less_do_not(self):
        self.assertEqual(prose.judge({"a.md": [self.complaint]}, {}), ["a.md:3: wrong"])
        self.assertEqual(len(prose.judge({"a.md": [self.complaint] * 2}, {"a.md": 1})), 3)
        self.assertEqual(len(prose.judge({"a.md": [self.complaint]}, {"a.md": 2})), 1)
        self.assertEqual(len(prose.judge({}, {"a.md": 2})), 1)

    def test_are_lowered_in_the_text_and_never_raised(self):
        allowed = {"a.md": 3, "b.md": 2, "c.md": 1, "d.md": 4}
        text = "".join(f'    "{group}": {limit},\n' for group, limit in allowed.items())
        found = {"a.md": [self.complaint], "b.md": [self.complaint] * 3, "c.md": []}
        self.assertEqual(prose.lowered(text, found, allowed), '    "a.md": 1,\n    "b.md": 2,\n')


class Command(unittest.TestCase):
    def run_on(self, text):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder, "page.md")
            page.write_text(text, encoding="utf-8")
            return subprocess.run([sys.executable, PROJECT / "tools" / "check_prose", page], capture_output=True,
                                  encoding="utf-8", check=False)

    def test_prints_file_line_and_what_is_wrong(self):
        answer = self.run_on("Short.\n\nIt is hardly so.\n")
        self.assertEqual(answer.returncode, 1)
        self.assertRegex(answer.stdout, r'page\.md:3: "hardly": write a number\n$')
        answer = self.run_on("Short.\n")
        self.assertEqual((answer.returncode, answer.stdout), (0, ""))

    def test_reads_the_top_section_of_a_changelog(self):
        text = "# Changelog\n\n## Next\n\nOf two.\n\n## 0.1\n\nOf three.\n"
        self.assertEqual(len(prose.of_page("CHANGELOG.md", prose.top_section(text.splitlines()))), 1)


if __name__ == "__main__":
    unittest.main()
