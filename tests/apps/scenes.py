"""Scenes as text, for tests of the tool."""

import json

TRIANGLE = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}


def body(name: str, **more) -> dict:
    return {"name": name, "shape": TRIANGLE, **more}


def falling(height: float) -> dict:
    """A body that falls 4 m within the step."""
    return body("stone", motion={"type": "constant_velocity", "from": {"position": [0.1, 0.1, height]},
                                 "translation": [0, 0, -4]})


def scene(*bodies: dict, **more) -> str:
    return json.dumps({"firstcontact": 1, "bodies": list(bodies), **more})


def plates(cells: int, **options) -> str:
    """Two square plates of so many cells of 1 mm along each side, 10 mm apart; the margin is 30 mm."""
    flat = {"heightmap": {"cell": [1e-3, 1e-3], "heights": [[0] * (cells + 1)] * (cells + 1)}}
    return json.dumps({"firstcontact": 1, "id": "plates", "options": {"margin": 0.03, **options}, "bodies": [
        {"name": "lower", "shape": flat}, {"name": "upper", "shape": flat, "pose": {"position": [0, 0, 0.01]}}]})


CONTACT = scene(body("floor"), falling(1), id="contact")
AT_START = scene(body("floor"), falling(0), id="at start")
FREE = scene(body("floor"), falling(5), id="free")
UNDECIDED = scene(body("floor"), falling(1), id="undecided", options={"deadline": 1e-9})
BAD = scene(body("floor", pose={"positon": [0, 0, 0]}))

# A box that falls on a floor and comes to rest there.
DROP = json.dumps({"firstcontact": 1, "id": "drop", "simulation": {"duration": 0.4, "step": 0.02}, "bodies": [
    {"name": "box", "shape": {"box": {"size": [1, 1, 1]}}, "pose": {"position": [0, 0, 0.6]}, "dynamics": {}},
    {"name": "floor", "shape": {"box": {"size": [9, 9, 0.1]}}}]})

# A tip that turns sixteen million times, and each time passes a wall at a millionth of a millimetre.
ENDLESS = scene(
    {"name": "tip", "shape": {"vertices": [[0, 0, 0], [1, 0, 0]], "triangles": [[0, 1, 1]]},
     "motion": {"type": "constant_velocity", "rotation_vector": [0, 0, 1e8]}},
    {"name": "wall", "shape": {"vertices": [[1, -9, -9], [1, 9, -9], [1, 0, 9]], "triangles": [[0, 1, 2]]},
     "pose": {"position": [1e-9, 0, 0]}},
    id="endless", options={"tolerance": 1e-12})
