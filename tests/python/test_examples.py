"""Examples run, and say what is right."""

import json
import math
import re
import subprocess
import sys

import pytest
from conftest import ROOT

FOLDER = ROOT / "examples/python"


def run(name: str, *arguments) -> str:
    done = subprocess.run([sys.executable, FOLDER / f"{name}.py", *map(str, arguments)],
                          capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_there_are_eleven():
    assert len(list(FOLDER.glob("*.py"))) == 11


def test_tumbling_box():
    told = run("tumbling_box")
    t = float(re.search(r"contact at t = ([0-9.]+)", told).group(1))

    def height(t):
        """Of the lowest corner over the floor."""
        turned = [0.1 * math.cos(2 * math.pi * t + k) + 0.1 * math.sin(2 * math.pi * t + k)
                  for k in (0, math.pi / 2, math.pi, 3 * math.pi / 2)]
        return 0.9 - t + min(turned)

    assert abs(height(t)) < 1e-3 and all(height(k / 1000 * t) > 0 for k in range(1000))
    assert "edge" in told or "vertex" in told


def test_falling_balls():
    told = run("falling_balls")
    first = float(re.search(r"balls \(\d+, \d+\) at t = ([0-9.]+)", told).group(1))
    then = float(re.search(r"held: t = ([0-9.]+)", told).group(1))
    assert 0 < first < 1 and first != then


def test_drone_and_cloud():
    told = run("drone_and_cloud")
    distance, bound, kept = (float(re.search(pattern, told).group(1)) for pattern in (
        r"([0-9.]+) m at t", r"less than ([0-9.]+) m", r"until t = ([0-9.]+)"))
    assert bound <= distance <= bound + 2e-3 and 0 < kept < 0.5
    # The corner of the drone is at 1.2 + 0.3 (cos 0.8 + sin 0.8) half way, the wall at 2 or nearer.
    assert distance < 2 - (1.2 + 0.3 * (math.cos(0.8) + math.sin(0.8)))


def test_peg_in_hole(tmp_path):
    page = tmp_path / "page.html"
    told = run("peg_in_hole", page).splitlines()
    assert told[0] == "Peg, straight: free" and told[1] == "Peg, tilted by 2 degrees: contact"
    assert told[2].startswith("peg and hole after ") and page.stat().st_size > 100_000


def test_many_tries():
    told = run("many_tries")
    least, most, free = re.search(r"free from (\S+) mm to (\S+) mm: (\d+) of 21", told).groups()
    assert -1 < float(least) < 0 < float(most) < 1 and 1 < int(free) < 21


def test_puma_and_post():
    told = run("puma_and_post")
    ends = float(re.search(r"ends ([0-9.]+) m", told).group(1))
    first = float(re.search(r"contact: post and Puma560/link\d after ([0-9.]+) s", told).group(1))
    spans = [tuple(map(float, s)) for s in re.findall(r"from ([0-9.]+) s to ([0-9.]+) s", told)]
    lift = float(re.search(r"lifted by ([0-9.]+) rad", told).group(1))
    # The post stands at a quarter of the swing's circle, which begins and ends at rest.
    assert ends > 0 and 0.5 < first < 1.5 and 0 < lift < 1.5
    assert min(enter for enter, _ in spans) == pytest.approx(first, abs=1e-3)
    assert all(enter < leave < 2 for enter, leave in spans)


def test_pushed_crate(tmp_path):
    told = run("pushed_crate", tmp_path / "run.jsonl")
    mass, place, nearest, force = (float(re.search(pattern, told).group(1)) for pattern in (
        r"has ([0-9.]+) kg", r"is at ([0-9.]+) m", r"than ([0-9.]+) µm", r"with ([0-9.]+) N"))
    assert mass == pytest.approx(200 * 0.4**3) and place == pytest.approx(0.5, abs=0.02)
    assert nearest > 0 and force == pytest.approx(9.81 * mass, rel=1e-3)
    assert told.splitlines()[-1] == "The run is proven"


def test_felt_hole(tmp_path):
    told = run("felt_hole", tmp_path / "map.svg", 5)
    up, led = zip(*(map(float, pair) for pair in re.findall(r"mm +(\S+) +(\S+)", told)))
    # The spring has 1,500 N/m and the handle is 0.5 mm below the rim; the tilt takes some of it.
    assert up[0] == pytest.approx(0.75, rel=0.05) and abs(led[0]) < 0.02
    # Chamfers of 45 degrees without friction lead sideways as much as up.
    assert 0.1 < up[1] < 0.3 and led[1] == pytest.approx(up[1], rel=0.02)
    assert up[2] == led[2] == 0
    assert up == pytest.approx(up[::-1], rel=1e-3) and led == pytest.approx(led[::-1], abs=1e-3)
    assert (tmp_path / "map.svg").read_text().count("<rect") == 25


def test_own_planner():
    told = run("own_planner")
    fraction = float(re.search(r"proven to ([0-9.]+) of", told).group(1))
    # Straight on its face meets that of the wall.
    assert "are free" in told and fraction == pytest.approx((0.8 - 0.002 - 5e-6) / 1.6, abs=1e-3)
    edges, length = re.search(r"path of (\d+) edges and ([0-9.]+) m", told).groups()
    # Not shorter than the straight way.
    assert int(edges) > 1 and float(length) >= math.hypot(1.6, 1.4)
    assert "\nall are proven" in told


def test_out_of_a_trap(tmp_path):
    told = run("out_of_a_trap", tmp_path / "page.html")
    bound, closest = (float(re.search(pattern, told).group(1))
                      for pattern in (r"edges, ([0-9.]+) mm", r"closest ([0-9.]+) mm"))
    assert told.startswith("proven: ") and "bug were in the way" in told
    # Half a gap of 10 mm is the most in the tube; the bound of the plan is one of the motion, too.
    assert 0 < bound <= closest <= 5.1
    assert (tmp_path / "page.html").stat().st_size > 100_000


def test_timed_path(tmp_path):
    told = run("timed_path", tmp_path / "way.yaml")
    durations = [float(found) for found in re.findall(r": proven, ([0-9.]+) s", told)]
    assert len(durations) == 3 and durations[2] <= durations[1] < durations[0]
    # The margin is 5 mm, less what the tracking error lets the arm come closer.
    assert all(float(found) > 5 for found in re.findall(r"points, ([0-9.]+) mm", told))
    assert all(50 < float(found) <= 100 for found in re.findall(r": ([0-9.]+) % of its limit", told))
    assert (tmp_path / "way.yaml").read_text().startswith("joint_names")


@pytest.mark.parametrize("notebook", sorted(FOLDER.glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebooks(notebook, capsys):
    cells = json.loads(notebook.read_text())["cells"]
    names = {}
    for cell in cells:
        assert cell.get("outputs", []) == []
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), notebook.name, "exec"), names)
    assert "proven - " in capsys.readouterr().out
