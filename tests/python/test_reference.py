"""The reference of the package holds each public name."""

import pathlib
import subprocess
import sys

import firstcontact as fc

TOOL = pathlib.Path(__file__).parents[2] / "tools" / "python_reference"


def test_reference_has_an_entry_of_each_public_name():
    reference = subprocess.run([sys.executable, TOOL], capture_output=True, text=True, check=False)
    assert reference.returncode == 0, reference.stderr
    entries = [line[4:] for line in reference.stdout.splitlines() if line.startswith("### ")]
    assert sorted(entries) == sorted(set(fc.__all__) - {"__version__"})
