"""Does the peg go into its hole? Reads scene files, and makes a page that shows the last answer.

    python3 peg_in_hole.py [PAGE.html]
"""

import pathlib
import sys

import firstcontact as fc

SCENES = pathlib.Path(__file__).resolve().parents[2] / "demo/scenes"

for name in ("peg_straight", "peg_tilted"):
    result = fc.check(SCENES / f"{name}.json")
    print(f"{result.id}: {result.verdict}")

# In the last scene the peg touches the hole. In a notebook, `result` alone shows the page.
print(f"{' and '.join(result.pair)} after {1000 * result.time:.1f} ms, {len(result.contacts)} contacts")
if len(sys.argv) > 1:
    result.save_html(sys.argv[1])
