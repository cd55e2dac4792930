"""What an answer says it is about: its files and its pairs."""

import pickle

import firstcontact as fc
import numpy as np
import pytest

BALL = {"name": "a", "shape": {"sphere": {"radius": 0.1}},
        "motion": {"type": "constant_velocity", "from": {"position": [0, 0, 1]},
                   "translation": [0, 0, -2]}}
PLATE = {"name": "b", "shape": {"box": {"size": [1, 1, 0.1]}}}


def box_text(size: tuple[float, float, float]) -> str:
    mesh = fc.make_box(size)
    vertices = "\n".join(" ".join(map(str, v)) for v in np.asarray(mesh.vertices))
    triangles = "\n".join("3 " + " ".join(map(str, t)) for t in np.asarray(mesh.triangles))
    return f"OFF\n{len(mesh.vertices)} {len(mesh.triangles)} 0\n{vertices}\n{triangles}\n"


def test_pairs_are_counted():
    scene = {"firstcontact": 1, "bodies": [BALL, PLATE, {**PLATE, "name": "c"}],
             "pairs": {"ignore": [["a", "b"]]}}
    result = fc.check(scene)
    counts = result.pair_counts
    assert (counts.tested, counts.ignored, counts.left_out) == (2, 1, 0)
    assert counts.untested == (fc.UntestedPairs("rule", 1, (("a", "b"),)),)
    assert result.to_dict()["pair_counts"]["tested"] == 2
    assert result.scene.pair_counts == counts
    assert "2 pairs tested" in repr(result)
    assert pickle.loads(pickle.dumps(result)).pair_counts == counts


def test_no_pair_is_warned_of():
    scene = {"firstcontact": 1, "bodies": [BALL, PLATE], "pairs": {"ignore": [["a", "b"]]}}
    result = fc.check(scene)
    assert result.verdict == "free"
    assert result.warnings[0].startswith("no pair is tested")
    assert "no pair tested" in repr(result)


def test_scripted_bodies_of_a_simulation_are_named(tmp_path):
    free = {"name": "c", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [3, 0, 2]},
            "dynamics": {}}
    scene = {"firstcontact": 1, "bodies": [BALL, PLATE, free], "simulation": {"duration": 0.05}}
    simulator = fc.Simulator(scene)
    assert simulator.pair_counts.tested == 2
    assert simulator.pair_counts.untested[0].why == "both_scripted" and simulator.pair_counts.untested[0].count == 1
    fc.simulate(scene, record=tmp_path / "run.jsonl")
    found = fc.verify_run(tmp_path / "run.jsonl")
    assert found.verdict == "proven" and found.pair_counts == simulator.pair_counts


def test_files_are_reported(tmp_path):
    (tmp_path / "m.off").write_text(box_text((1, 2, 3)))
    scene = {"firstcontact": 1,
             "bodies": [BALL, {"name": "m", "shape": {"mesh": str(tmp_path / "m.off")}}]}
    report, = fc.check(scene).files
    assert report.path == str(tmp_path / "m.off") and report.contents["triangles"] == 12
    reading = fc.read_mesh_file(tmp_path / "m.off")
    assert reading.report == report
    assert len(reading.mesh.triangles) == 12
    assert fc.load_scene(scene).files == (report,)


def test_units_are_judged(tmp_path):
    (tmp_path / "post.off").write_text(box_text((50, 50, 600)))
    post = {"name": "post", "shape": {"mesh": str(tmp_path / "post.off"), "solid": True},
            "pose": {"position": [900, 0, 0]}}
    scene = fc.load_scene({"firstcontact": 1, "bodies": [BALL, post]})
    assert any("is its unit right?" in warning for warning in scene.warnings)
    assert "is its unit right?" in repr(scene) and "scale=0.001" in repr(scene)
    assert "scale=0.001" in repr(fc.read_mesh_file(tmp_path / "post.off"))
    mended = fc.read_mesh_file(tmp_path / "post.off", scale=0.001)
    assert "scale" not in repr(mended)
    assert np.ptp(mended.mesh.vertices[:, 2]) == pytest.approx(0.6)
    assert np.array_equal(fc.read_mesh(tmp_path / "post.off", scale=0.001).vertices,
                          mended.mesh.vertices)
    with pytest.raises(ValueError, match="scale must be > 0"):
        fc.read_mesh(tmp_path / "post.off", scale=0)


def test_what_begins_inside_is_warned_of(tmp_path):
    (tmp_path / "table.off").write_text(box_text((4, 4, 4)))
    table = {"name": "table", "shape": {"mesh": str(tmp_path / "table.off")}}
    result = fc.check({"firstcontact": 1, "bodies": [BALL, table]})
    assert result.verdict == "free"
    assert 'begins inside the closed mesh of "table"' in result.warnings[0]


def test_lenient_reading_stays_with_the_scene():
    scene = {"firstcontact": 1, "bodies": [BALL, PLATE]}
    assert fc.load_scene(scene, lenient=True).to_dict()["options"]["lenient"] is True
    assert "lenient" not in fc.load_scene(scene).to_dict()["options"]
    assert fc.check(scene, lenient=True).to_dict()["scene"]["options"]["lenient"] is True
    result, = fc.check_many([scene], lenient=True)
    assert result.to_dict()["scene"]["options"]["lenient"] is True
