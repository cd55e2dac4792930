"""What the tests share: scenes, the tool, shapes."""

import json
import os
import pathlib
import subprocess

import firstcontact as fc
import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRIANGLE = ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]])


@pytest.fixture(scope="session")
def tool() -> pathlib.Path:
    """The command line tool, as it was built with the C++ tests."""
    return pathlib.Path(os.environ.get("FIRSTCONTACT_TOOL", ROOT / "build/ci/apps/firstcontact"))


@pytest.fixture(scope="session")
def ask_tool(tool):
    """Calls `firstcontact check --json`."""
    def ask(*arguments) -> dict:
        run = subprocess.run([tool, "check", "--json", *map(str, arguments)], capture_output=True,
                             text=True, timeout=300, check=False)
        assert run.stdout, run.stderr
        return json.loads(run.stdout)
    return ask


@pytest.fixture
def triangle() -> fc.Shape:
    return fc.Shape(TRIANGLE)


@pytest.fixture
def falling() -> fc.Motion:
    """2 m down from 1 m above."""
    return fc.Motion.constant_velocity(fc.Pose((0.1, 0.1, 1.0)), translation=(0, 0, -2))


@pytest.fixture
def arm_folder(tmp_path) -> pathlib.Path:
    """Holds arm.urdf: a bar of 1 m that turns about z by `elbow`, with a ball at its tip."""
    (tmp_path / "arm.urdf").write_text("""<robot name="arm">
      <link name="base"/>
      <link name="bar"><collision><origin xyz="0.5 0 0"/>
        <geometry><box size="1 0.1 0.1"/></geometry></collision></link>
      <link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="elbow" type="revolute"><parent link="base"/><child link="bar"/>
        <axis xyz="0 0 1"/><limit lower="-1" upper="1.5" velocity="1" effort="1"/></joint>
      <joint name="weld" type="fixed"><parent link="bar"/><child link="tip"/>
        <origin xyz="1.05 0 0"/></joint>
    </robot>""")
    return tmp_path


def without_work(result: dict) -> dict:
    """Counts of work are outside of what repeats."""
    return {key: value for key, value in result.items() if key != "work"}


def falling_scene(height: float = 1.0, **options) -> dict:
    """A triangle that falls 4 m in a step of 2 s onto another one."""
    shape = {"vertices": TRIANGLE[0], "triangles": TRIANGLE[1]}
    return {"firstcontact": 1, "id": f"from {height} m",
            "bodies": [{"name": "floor", "shape": shape},
                       {"name": "stone", "shape": shape,
                        "motion": {"type": "constant_velocity", "from": {"position": [0.1, 0.1, height]},
                                   "translation": [0, 0, -4]}}],
            "options": {"duration": 2, **options}}


def sphere(radius: float, rings: int) -> fc.Shape:
    """A sphere of triangles."""
    polar, around = np.meshgrid(np.linspace(0, np.pi, rings + 1),
                                np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False), indexing="ij")
    vertices = radius * np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around),
                                  np.cos(polar)], axis=-1).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(rings), np.arange(2 * rings), indexing="ij")
    a = row * 2 * rings + column
    b = row * 2 * rings + (column + 1) % (2 * rings)
    triangles = np.concatenate([np.stack([a, b, a + 2 * rings], axis=-1).reshape(-1, 3),
                                np.stack([b, b + 2 * rings, a + 2 * rings], axis=-1).reshape(-1, 3)])
    return fc.Shape((vertices, triangles))


def long_query() -> tuple:
    """Two concentric spheres, each spinning: every triangle stays close to others. Takes minutes."""
    spin = fc.Motion.constant_velocity(fc.Pose(), (0, 0, 0), rotation_vector=(0, 500, 300))
    turn = fc.Motion.constant_velocity(fc.Pose(), (0, 0, 0), rotation_vector=(400, 0, 900))
    return (sphere(1.0, 150), spin), (sphere(1.001, 150), turn)


def resting_balls(count: int) -> dict:
    """Balls that spin on a floor, simulated for days."""
    ball = {"shape": {"sphere": {"radius": 0.5}}}
    return {"firstcontact": 1, "simulation": {"duration": 1e6, "step": 0.01}, "bodies": [
        {"name": "floor", "shape": {"box": {"size": [99, 99, 1]}}},
        *({**ball, "name": f"ball {k}", "pose": {"position": [1.1 * (k % 8), 1.1 * (k // 8), 1.01]},
           "dynamics": {"angular_velocity": [k, 0, 1]}} for k in range(count))]}
