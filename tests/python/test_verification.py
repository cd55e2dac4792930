"""Second proofs of results and paths."""

import json

import pytest

import firstcontact as fc
from test_planning import SCENE as TO_PLAN

FALL = {
    "firstcontact": 1,
    "bodies": [
        {"name": "ball", "shape": {"sphere": {"radius": 0.5}},
         "motion": {"type": "constant_velocity", "from": {"position": [0, 0, 3]},
                    "translation": [0, 0, -4]}},
        {"name": "floor", "shape": {"box": {"size": [4, 4, 1]}}},
    ],
}


def edited(text, change):
    """The text of an object after a change of it."""
    values = json.loads(text)
    change(values)
    return json.dumps(values)


def test_proves_a_result(tmp_path):
    result = fc.check(FALL)
    proof = fc.verify_result(result)
    assert proof.verdict == "proven" and proof.problem == "" and proof.problem_at is None
    assert proof.t == result.t and proof.contacts >= 1 and 0.0 <= proof.contact_distance <= proof.tolerance
    assert proof.pair_counts == result.pair_counts and proof.has_digests
    (tmp_path / "result.json").write_text(result.to_json())
    assert fc.verify_result(tmp_path / "result.json") == proof
    assert fc.verify_result(str(tmp_path / "result.json"), threads=1) == proof


def test_refutes_a_result_that_claims_too_much(tmp_path):
    file = tmp_path / "result.json"

    def later(claims):
        claims.update(t=0.6, time=0.6, t_upper=0.6)
    file.write_text(edited(fc.check(FALL).to_json(), later))
    proof = fc.verify_result(file)
    assert proof.verdict == "refuted" and proof.problem
    assert set(proof.problem_at.pair) == {"ball", "floor"} and proof.problem_at.begin >= 0.5 - 1e-6
    file.write_text("{")
    with pytest.raises(fc.ParseError, match="result.json"):
        fc.verify_result(file)
    with pytest.raises(FileNotFoundError):
        fc.verify_result(tmp_path / "none.json")


def test_proves_a_path(tmp_path):
    answer = fc.plan(TO_PLAN)
    proof = fc.verify_path(answer)
    assert proof.verdict == "proven" and proof.reaches_goal
    assert proof.edges == len(answer.waypoints) - 1 and proof.tested == 1
    (tmp_path / "path.json").write_text(answer.json)
    assert fc.verify_path(tmp_path / "path.json") == proof


def test_refutes_a_path_through_a_wall(tmp_path):
    def straight(path):
        path["waypoints"] = [path["waypoints"][0], path["waypoints"][-1]]
        path["edges"] = path["edges"][:1]
    file = tmp_path / "path.json"
    file.write_text(edited(fc.plan(TO_PLAN).json, straight))
    proof = fc.verify_path(file)
    assert proof.verdict == "refuted" and proof.problem_edge == 0
    assert set(proof.problem_at.pair) == {"peg", "wall"} and 0.0 < proof.problem_at.begin < 1.0


def test_needs_a_path():
    blocked = {**TO_PLAN, "bodies": [
        {"name": "wall", "shape": {"box": {"size": [1e-5, 1, 1]}}}, TO_PLAN["bodies"][1],
        *({"name": f"side{k}", "shape": {"box": {"size": [3, 3, 3]}},
           "pose": {"position": [-0.5 + 1.9 * x, 1.9 * y, 1.9 * z]}}
          for k, (x, y, z) in enumerate([(-1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)]))]}
    blocked["bodies"][0]["shape"]["box"]["size"] = [1e-5, 9, 9]
    answer = fc.plan(blocked, time=0.2)
    assert answer.verdict == "none"
    with pytest.raises(ValueError, match='path: expected an answer with a path'):
        fc.verify_path(answer)
