"""Scenes answer as the tool does, bit for bit."""

import html
import json
import math
import pickle
import re
import subprocess

import firstcontact as fc
import numpy as np
import pytest
from conftest import ROOT, TRIANGLE, falling_scene, without_work
from firstcontact import _page

# Without the nut, which takes seconds.
SCENES = sorted([*(ROOT / "demo/scenes").glob("[bp]*.json"),
                 *(ROOT / "tests/fuzz/corpus/fuzz_scene/good").glob("*.json")])
PAGE_OPTIONS = {"all_pairs": True, "closest": True, "sample_rate": 20}


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_result_is_the_tools(path, ask_tool):
    expected = without_work(ask_tool(path))
    result = fc.check(path)
    assert without_work(result.to_dict()) == expected
    assert json.loads(result.to_json()) == result.to_dict()


@pytest.mark.parametrize("path", SCENES[:4], ids=lambda path: path.stem)
def test_options_are_the_tools(path, ask_tool):
    expected = ask_tool("--all-pairs", "--closest", "--sample-rate", "20", "--margin", "0.001",
                        "--tolerance", "1e-5", path)
    result = fc.check(str(path), margin=0.001, tolerance=1e-5, threads=1, **PAGE_OPTIONS)
    assert without_work(result.to_dict()) == without_work(expected)


def test_attributes_are_those_of_the_json():
    result = fc.check(falling_scene(), all_pairs=True, closest=True)
    told = result.to_dict()
    for name in ("id", "verdict", "t", "t_upper", "time", "clearance"):
        assert getattr(result, name) == told[name]
    assert result.reason == "none" and told["reason"] is None
    assert list(result.pair) == told["pair"] == ["floor", "stone"]
    assert result.time == 2 * result.t == pytest.approx(0.5)
    for contact, expected in zip(result.contacts, told["contacts"], strict=True):
        assert list(contact.bodies) == expected["bodies"]
        assert [{"type": f.type, "index": f.index} for f in contact.features] == expected["features"]
        assert list(contact.triangles) == expected["triangles"]
        assert contact.points.tolist() == expected["points"]
        assert contact.normal.tolist() == expected["normal"]
        assert contact.distance == expected["distance"]
        assert contact.normal_velocity == expected["normal_velocity"]
    assert result.contacts[-1].normal_velocity == -2.0  # [m/s], half of what it is per step.
    assert result.closest.distance == told["closest"]["distance"]
    assert result.closest.points.tolist() == told["closest"]["points"]
    pair, expected = result.pairs[0], told["pairs"][0]
    for name in ("verdict", "margin", "t", "t_upper", "time", "clearance"):
        assert getattr(pair, name) == expected[name]
    assert pair.closest.time == expected["closest"]["time"]


def plates(**options):
    flat = {"heightmap": {"cell": [1e-3, 1e-3], "heights": np.zeros((11, 11))}}
    return {"firstcontact": 1, "options": {"margin": 0.03, **options}, "bodies": [
        {"name": "lower", "shape": flat},
        {"name": "upper", "shape": flat, "pose": {"position": [0, 0, 0.01]}}]}


def test_contacts_are_those_that_are_asked_for():
    usual = fc.check(plates())
    assert len(usual.contacts) == 1000 < usual.contact_count
    assert usual.contact_count_is_exact
    everything = fc.check(plates(), contacts="all")
    assert len(everything.contacts) == everything.contact_count == usual.contact_count
    few = fc.check(plates(contacts=5))
    assert len(few.contacts) == len(few.pairs[0].contacts) == 5
    assert few.contact_count == few.pairs[0].contact_count == usual.contact_count
    assert len(fc.check(plates(contacts=5), contacts=7).contacts) == 7
    first = fc.check(plates(), contacts=fc.ContactState.first)
    assert (len(first.contacts), first.contact_count, first.contact_count_is_exact) == (1, 1, False)
    assert pickle.loads(pickle.dumps(few)).contact_count == few.contact_count
    many = fc.check_many([plates(), plates(contacts="none")], contacts=3)
    assert [len(result.contacts) for result in many] == [3, 3]
    for wrong in (0, -1):
        with pytest.raises(ValueError, match="contacts must be >= 1"):
            fc.check(plates(), contacts=wrong)


def test_dict_may_hold_arrays_and_paths():
    scene = falling_scene()
    expected = without_work(fc.check(scene).to_dict())
    for body in scene["bodies"]:
        body["shape"] = {"vertices": np.array(TRIANGLE[0]), "triangles": np.array(TRIANGLE[1])}
    scene["options"]["duration"] = np.float64(2)
    told = without_work(fc.check(scene).to_dict())
    for digest in ("input_digest", "scene_digest"):
        assert told.pop(digest) != expected.pop(digest)  # The text differs: 0.0 and 0.
    assert told == expected
    scene["bodies"][0]["shape"] = {"mesh": ROOT / "data/stanford/stanford-bunny.obj"}
    assert fc.load_scene(scene).bodies == ("floor", "stone")


def test_scene_shows_what_was_read():
    scene = fc.load_scene(falling_scene())
    assert (scene.id, scene.duration, scene.bodies) == ("from 1.0 m", 2.0, ("floor", "stone"))
    assert scene.to_dict()["options"]["tolerance"] == 1e-6
    assert fc.load_scene(scene) is scene
    assert fc.check(scene).scene is scene
    assert fc.parse_scene(json.dumps(falling_scene())).to_json() == scene.to_json()
    assert "from 1.0 m" in repr(scene)


@pytest.mark.parametrize("scene, complaint", [
    ({}, r'scene:1: expected "firstcontact": 1'),
    ({"firstcontact": 1, "bodeis": []}, r'unknown key; did you mean "bodies"'),
    (falling_scene(tolerance=0), r"scene:1: options.tolerance: expected"),
    (falling_scene(math.nan), "scene:1: .*expected"),
])
def test_bad_scene_is_a_parse_error(scene, complaint):
    with pytest.raises(fc.ParseError, match=complaint) as error:
        fc.check(scene)
    assert error.value.path == "scene" and error.value.line == 1


def test_bad_files_and_arguments(tmp_path):
    with pytest.raises(FileNotFoundError) as missing:
        fc.check(tmp_path / "none.json")
    assert missing.value.filename == str(tmp_path / "none.json")
    bad = tmp_path / "bad.json"
    bad.write_text('{"firstcontact": 1,\n "bodies": 3}')
    with pytest.raises(fc.ParseError, match=r"bad\.json:2: bodies: expected"):
        fc.check(bad)
    with pytest.raises(TypeError, match="got object"):
        fc.check({"firstcontact": 1, "id": object()})
    for options in ({"margin": -1}, {"tolerance": math.nan}, {"deadline": 0}, {"sample_rate": 0}):
        with pytest.raises(ValueError):
            fc.check(falling_scene(), **options)


def test_scene_pickles_with_its_answer():
    for path in SCENES[:3]:
        scene = fc.load_scene(path)
        again = pickle.loads(pickle.dumps(scene))
        assert again.input_digest == scene.input_digest
        assert without_work(fc.check(again).to_dict()) == without_work(fc.check(scene).to_dict())


def test_result_pickles_whole():
    for path in SCENES[:3]:
        result = fc.check(path, **PAGE_OPTIONS)
        again = pickle.loads(pickle.dumps(result))
        assert again.to_json() == result.to_json()
        for part in (*result.contacts, *result.pairs, result.closest):
            copy = pickle.loads(pickle.dumps(part))
            assert repr(copy) == repr(part)
        for contact in result.contacts:
            assert pickle.loads(pickle.dumps(contact)).bodies == contact.bodies


def test_shapes_are_shared_between_scenes(tmp_path):
    mesh = tmp_path / "mesh.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = {"firstcontact": 1, "bodies": [{"name": "a", "shape": {"mesh": mesh}}]}
    shapes = fc.ShapeCache()
    digest = fc.load_scene(scene, shapes).input_digest
    mesh.write_text("v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n")
    assert fc.load_scene(scene, shapes).input_digest == digest
    assert fc.load_scene(scene).input_digest != digest


def test_gap_is_sampled():
    gap = fc.sample_gap(fc.load_scene(falling_scene()), [1.0, 0.0, 0.125])
    np.testing.assert_array_equal(gap.t, [0, 0.125, 1])
    np.testing.assert_allclose(gap.distance, [1, 0.5, 3], rtol=1e-12)
    assert (gap.lower_bound <= gap.distance).all()
    with pytest.raises(ValueError, match=r"in \[0, 1\], got 1.5"):
        fc.sample_gap(fc.load_scene(falling_scene()), [1.5])


def test_gap_curve_has_a_proven_lower_bound():
    result = fc.check(falling_scene())
    samples, bound = result.gap_curve()
    assert result.t in samples.t and samples.t[0] == 0 and samples.t[-1] == 1
    np.testing.assert_allclose(samples.distance, abs(1 - 4 * samples.t), atol=1e-9)
    truth = abs(1 - 4 * bound.t)
    assert (bound.distance <= truth + 1e-12).all() and len(bound.t) > 10


def page_data(page: str) -> dict:
    return json.loads(re.search(r'\{"result":.*?(?=</script>)', page, re.DOTALL).group(0))


def test_page_is_the_tools(tmp_path, tool):
    path = ROOT / "demo/scenes/peg_tilted.json"
    subprocess.run([tool, "check", path, "--html", tmp_path / "tool.html"], capture_output=True,
                   check=False, cwd=ROOT)
    result = fc.check(path)
    result.save_html(tmp_path / "ours.html")
    ours = (tmp_path / "ours.html").read_text()
    theirs = (tmp_path / "tool.html").read_text()
    assert without_work(page_data(ours)["result"]) == without_work(page_data(theirs)["result"])
    assert page_data(ours)["view"] == page_data(theirs)["view"]
    assert ours.count("<script") == theirs.count("<script")


def test_notebook_shows_the_page():
    result = fc.check({**falling_scene(), "id": 'a "quoted" & <b>bold</b> scene'})
    view = result._repr_html_()
    match = re.fullmatch(r'<iframe title="([^"<>]*)" style="[^"]*" allow="fullscreen" '
                         r'srcdoc="([^"]*)"></iframe>', view)
    assert html.unescape(match.group(1)) == result.id
    assert html.unescape(match.group(2)) == result.to_html()


def test_notebook_without_a_page_shows_a_line(monkeypatch, tmp_path):
    monkeypatch.setattr(_page, "TEMPLATE", tmp_path / "viewer.html")
    result = fc.check(falling_scene())
    assert "&lt;Result &#x27;from 1.0 m&#x27;: contact" in result._repr_html_()
    with pytest.raises(FileNotFoundError, match="FIRSTCONTACT_BUILD_VIEWER"):
        result.to_html()
