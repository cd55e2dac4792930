"""Makes C++ files of the C++ blocks in the pages, which a project that knows the installed package alone compiles.

    page_snippets.py ROOT FOLDER [--ompl]

The blocks below one heading are one function: each stands in the scope of the one before it. A heading whose blocks
name headers is a file that includes these and no other. Blocks that leave the headers out stand in snippets.cpp, which
has to be compiled with all of them. A block with a main() is a program, snippet_main_*.cpp. With --ompl, blocks that
include headers for OMPL are made, too.
"""

import pathlib
import re
import sys

# What the blocks below a heading take for granted: parameters of the function around them.
GIVEN = {
    "README.md": {"From C++": ""},
    "docs/avatars.md": {"Avatars": ""},
    "docs/cpp.md": {
        "First contact of two bodies": "",
        "Many bodies": "const std::vector<std::pair<Shape, Motion>>& parts, const Motion& other_motion",
        "A robot": "",
        "The motion of a robot": "const RobotModel& model",
        "Two links": "const RobotMotion& motion, std::size_t hand, std::size_t forearm, const Shape& hand_shape, "
                     "const Shape& forearm_shape",
        "A whole trajectory": "const RobotMotion& motion, const RobotSemantics& semantics, const Shape& part_shape, "
                              "const Pose& X_WPart, const std::vector<RobotMotion>& edges",
        "Limits of joints": "const RobotMotion& motion",
        "Simulations": "Simulator& simulator, std::size_t crate, std::size_t floor",
    },
    "docs/haptic_devices.md": {"A plug-in for another device": ""},
    "docs/haptics.md": {"In C++": "const Shape& peg, const Shape& hole, Device& device"},
    "docs/planning.md": {
        "In C++": "const PlanScene& scene, const Configuration& from, const Configuration& to",
        "With planners of OMPL": "const firstcontact::PlanScene& scene, ompl::geometric::PathGeometric& path",
    },
    "docs/retiming.md": {"In C++": "const WaypointPath& path, const std::vector<RateLimits>& limits, "
                                   "const RetimingScene& where"},
    "docs/site/index.md": {"3. Ask from a program": ""},
}


def blocks(text: str):
    """Yields (heading, block) of each C++ block."""
    heading, fence, lines = "", None, []
    for line in text.splitlines():
        if line.startswith("```"):
            if fence == "```cpp":
                yield heading, "\n".join(lines) + "\n"
            fence, lines = (None, []) if fence else (line, [])
        elif fence:
            lines.append(line)
        elif line.startswith("#"):
            heading = line.lstrip("# ")


def parted(block: str) -> tuple:
    """The includes of a block, and the rest."""
    lines = block.splitlines(keepends=True)
    return ("".join(line for line in lines if line.startswith("#include")),
            "".join(line for line in lines if not line.startswith("#include")))


def function(name: str, given: str, bodies: list) -> str:
    opened = "{\n".join(bodies)
    return f"void {name}({given}) {{\n{opened}{'}' * len(bodies)}\n"


def files_of(page: str, text: str, with_ompl: bool):
    """Yields (file, text) for the headings of a page; the file is None for blocks that leave the headers out."""
    given = GIVEN.get(page, {})
    found = {}
    for heading, block in blocks(text):
        found.setdefault(heading, []).append(parted(block))
    for heading in {*found, *given}:
        if heading not in found or heading not in given:
            raise ValueError(f'{page}: heading "{heading}": the blocks below it and their entry in GIVEN of '
                             "tests/consumer/page_snippets.py go together")
    for heading, pairs in found.items():
        name = re.sub(r"\W+", "_", f"{page}_{heading}").strip("_").lower()
        includes = "".join(part for part, _ in pairs)
        bodies = [body for _, body in pairs]
        if "<firstcontact_ompl/" in includes and not with_ompl:
            continue
        if any("int main(" in body for body in bodies):
            yield f"snippet_main_{name}.cpp", includes + "".join(bodies)
        else:
            code = function(name, given[heading], bodies)
            yield (f"snippet_{name}.cpp", f"{includes}using namespace firstcontact;\n{code}") if includes else (None, code)


def main() -> int:
    root, folder, *options = sys.argv[1:]
    pages = [path for path in (pathlib.Path(root, "README.md"), *sorted(pathlib.Path(root, "docs").rglob("*.md")))
             if path.parent.name != "decisions"]
    made = {"snippets.cpp": '#include <array>\n#include <iostream>\n#include "all_headers.h"\n'
                            "using namespace firstcontact;\n"}
    for path in pages:
        page = path.relative_to(root).as_posix()
        for file, text in files_of(page, path.read_text(encoding="utf-8"), "--ompl" in options):
            if file is None:
                made["snippets.cpp"] += text
            else:
                made[file] = text
    for file, text in made.items():
        pathlib.Path(folder, file).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
