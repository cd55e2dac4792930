"""How much play does the peg have? Checks many scenes at once, in two processes."""

import pathlib
from concurrent.futures import ProcessPoolExecutor

import firstcontact as fc
import numpy as np

SCENE = pathlib.Path(__file__).resolve().parents[2] / "demo/scenes/peg_straight.json"


def beside(scene: fc.Scene, offset: float) -> dict:
    """Returns the scene with the peg moved along x [m]."""
    moved = scene.to_dict()
    motion = moved["bodies"][0]["motion"]
    for pose in {"from", "to"} & motion.keys():
        motion[pose]["position"][0] += offset
    return moved


def main() -> None:
    scene = fc.load_scene(SCENE)
    offsets = np.linspace(-1e-3, 1e-3, 21)
    with ProcessPoolExecutor(2) as executor:  # Without an executor, check_many uses threads of its own.
        results = fc.check_many([beside(scene, offset) for offset in offsets], executor)
    free = [1000 * offset for offset, result in zip(offsets, results) if result.verdict == "free"]
    print(f"free from {min(free):.1f} mm to {max(free):.1f} mm: {len(free)} of {len(results)} tries")


if __name__ == "__main__":
    main()
