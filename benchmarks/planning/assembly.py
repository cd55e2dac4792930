#!/usr/bin/env python3
"""Takes parts apart and puts them together again, by paths that are proven edge by edge.

    assembly.py TOOL DATA [--time SECONDS] [--seed N] [--only NAME,NAME] [--verify-time SECONDS]

TOOL is the program firstcontact; DATA the folder of data sets (FIRSTCONTACT_DATA_DIR), with Factory's
parts in assemblies/factory. An M8 nut and five beams are made here, with clearances that are known.
For each assembly: `firstcontact plan` from the assembled place to one outside, and back; `firstcontact
verify` of both paths. No pitch, no axis and no direction is given. Then what must be refused: threads
that do not fit. Exit status 1 where anything fails; a proof that takes longer than --verify-time is
left out, and the line says so. Times are wall clock of the tool, reading of meshes included.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

import parts


def box(size):
    return {"box": {"size": size}}


def square_hole(side, depth):
    """Four blocks around a square hole along z, from z = 0 to depth."""
    out = 0.03
    mid = (side / 2 + out) / 2
    wide = out - side / 2
    blocks = [("east", [mid, 0, depth / 2], [wide, 2 * out, depth]),
              ("west", [-mid, 0, depth / 2], [wide, 2 * out, depth]),
              ("north", [0, mid, depth / 2], [side, wide, depth]),
              ("south", [0, -mid, depth / 2], [side, wide, depth]),
              ("floor", [0, 0, -0.005], [2 * out, 2 * out, 0.01])]
    return [{"name": name, "shape": box(size), "pose": {"position": place}} for name, place, size in blocks]


def square_peg(clearance):
    """A square peg of 16 mm in a hole that is wider by twice the clearance, 20 mm deep."""
    return (square_hole(0.016 + 2 * clearance, 0.02)
            + [{"name": "part", "shape": box([0.016, 0.016, 0.04]), "pose": {"position": [0, 0, 0.0201]}}],
            {"position": [0.02, 0.01, 0.08], "rpy": [0.3, 0.2, 0.1]})


def meshes(data, fixed, moved, start, goal):
    return ([{"name": "base", "shape": {"mesh": str(data / fixed)}},
             {"name": "part", "shape": {"mesh": str(data / moved)}, "pose": {"position": start}}],
            {"position": goal})


def assemblies(data, made):
    found = {"square peg, 0.1 mm": square_peg(1e-4), "square peg, 0.01 mm": square_peg(1e-5),
             **parts.five_beams(made, 1e-3), **parts.five_beams(made, 1e-4), "nut m8, made": parts.nut_m8(made)}
    folder = pathlib.Path("factory_insertion")
    for kind in ("round", "rectangular"):
        for size in (8, 16):
            for fit in ("tight", "loose"):
                end = ".obj" if kind == "round" else "_subdiv_3x.obj"
                found[f"{kind} peg {size} mm, {fit}"] = meshes(
                    data, folder / f"factory_{kind}_hole_{size}mm_subdiv_3x.obj",
                    folder / f"factory_{kind}_peg_{size}mm_{fit}{end}", [0, 0, 1e-4], [0.01, 0.005, 0.03])
    folder = pathlib.Path("factory_gears")
    found["gear on shaft"] = meshes(data, folder / "factory_gear_base_loose_space_5e-4_subdiv_4x.obj",
                                    folder / "factory_gear_small_space_5e-4.obj", [0, 0, 5e-4], [0, 0, 0.05])
    folder = pathlib.Path("factory_nut_bolt")
    for size, fit, height, turn in (("m12", "loose", 0.0105, math.pi / 4), ("m16", "loose", 0.012, 0.0),
                                    ("m16", "tight", 0.012, 0.0)):
        bodies, goal = meshes(data, folder / f"factory_bolt_{size}_{fit}.obj",
                              folder / f"factory_nut_{size}_{fit}_subdiv_3x.obj", [0, 0, height], [0, 0, 0.05])
        bodies[1]["pose"]["rpy"] = [0, 0, turn]
        found[f"nut {size}, {fit}"] = bodies, goal
    return found


def stretched(source, target, factor):
    """A mesh whose lengths along z are longer by a factor: a thread of another pitch."""
    with open(source, encoding="utf-8") as lines, open(target, "w", encoding="utf-8") as out:
        for line in lines:
            if line.startswith("v "):
                x, y, z = map(float, line.split()[1:4])
                line = f"v {x!r} {y!r} {z * factor!r}\n"
            out.write(line)


class Campaign:
    def __init__(self, arguments, folder):
        self.tool = str(pathlib.Path(arguments.tool).resolve())
        self.time = arguments.time
        self.seed = arguments.seed
        self.verify_time = arguments.verify_time
        self.folder = folder
        self.failed = 0

    def run(self, *arguments):
        begin = time.monotonic()
        done = subprocess.run([self.tool, *arguments], cwd=self.folder, capture_output=True, text=True, check=False)
        return done, time.monotonic() - begin

    def write(self, name, value):
        (self.folder / name).write_text(json.dumps(value), encoding="utf-8")

    def plan(self, bodies, goal):
        self.write("scene.json", {"firstcontact": 1, "bodies": bodies, "options": {"tolerance": 1e-7},
                                  "plan": {"body": "part", "goal": goal, "contacts": "both",
                                           "seed": self.seed, "time": self.time}})
        (self.folder / "path.json").unlink(missing_ok=True)
        return self.run("plan", "scene.json", "-o", "path.json", "--shortcuts", "0")

    def verdict(self, name):
        begin = time.monotonic()
        try:
            done = subprocess.run([self.tool, "verify", name, "--json"], cwd=self.folder, capture_output=True,
                                  text=True, check=False, timeout=self.verify_time)
        except subprocess.TimeoutExpired:
            return f"no proof within {self.verify_time:g} s"
        answer = json.loads(done.stdout)["verdict"] if done.stdout else done.stderr.strip()
        self.failed += answer != "proven"
        return f"{answer} ({time.monotonic() - begin:.1f} s)"

    def one_way(self, sense, bodies, goal):
        """What is to say of one path; none where there is none."""
        done, seconds = self.plan(bodies, goal)
        if done.returncode != 0:
            self.failed += 1
            return f"{sense} {seconds:.1f} s FAILED: {(done.stdout or done.stderr).strip().splitlines()[0]}"
        path = json.loads((self.folder / "path.json").read_text())
        turn = sum(2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(p[3:], q[3:])))))
                   for p, q in zip(path["waypoints"], path["waypoints"][1:]))
        return (f"{sense} {seconds:5.1f} s {len(path['edges']):4} edges {turn / (2 * math.pi):5.1f} turns "
                f"{1e6 * path['clearance']:8.3f} um, verify: {self.verdict('path.json')}")

    def take_apart(self, name, bodies, goal):
        print(f"{name:28} {self.one_way('out', bodies, goal)}", flush=True)
        assembled = bodies[-1]["pose"]
        bodies = bodies[:-1] + [dict(bodies[-1], pose=goal)]
        print(f"{'':28} {self.one_way('in ', bodies, assembled)}", flush=True)

    def refuse(self, name, bodies, goal, start=None):
        if start is not None:
            bodies[-1]["pose"] = start
        done, seconds = self.plan(bodies, goal)
        refused = done.returncode in (1, 2) and not (self.folder / "path.json").exists()
        self.failed += not refused
        line = (done.stderr or done.stdout).strip().splitlines()[0]
        print(f"{name:28} {seconds:7.1f} s  {'refused' if refused else 'NOT REFUSED'}: {line[:150]}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--time", type=float, default=30.0, help="[s] of the planner, for each")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--verify-time", type=float, default=60.0, help="[s] of each second proof")
    parser.add_argument("--only", default="", help="names that contain one of these words, with commas between")
    arguments = parser.parse_args()
    data = (arguments.data / "assemblies/factory/mesh").resolve()
    words = [word for word in arguments.only.split(",") if word]
    with tempfile.TemporaryDirectory() as name:
        campaign = Campaign(arguments, pathlib.Path(name))
        for name, (bodies, goal) in assemblies(data, campaign.folder).items():
            if not words or any(word in name for word in words):
                campaign.take_apart(name, bodies, goal)
        if not words or "wrong" in words:
            nut = data / "factory_nut_bolt/factory_nut_m16_loose_subdiv_3x.obj"
            bolt = "factory_nut_bolt/factory_bolt_m16_loose.obj"
            stretched(nut, campaign.folder / "wrong.obj", 1.1)
            bodies, _ = meshes(data, bolt, nut, [0, 0, 0.05], [0, 0, 0])
            bodies[1]["shape"]["mesh"] = "wrong.obj"
            campaign.refuse("wrong pitch, onto the bolt", bodies, {"position": [0, 0, 0.012 - 0.0016]})
            bodies, _ = meshes(data, bolt, nut, [0, 0, 0.05], [0, 0, 0])
            campaign.refuse("crossed threads", bodies, {"position": [0, 0, 0.012], "rpy": [0.05, 0, 0]})
            campaign.refuse("beams that lock", *parts.five_beams(campaign.folder, 1e-4, True)["five beams, E, 0.1 mm"])
    return 1 if campaign.failed else 0


if __name__ == "__main__":
    sys.exit(main())
