"""Parts whose clearance is known by construction: an M8 nut on its bolt, and a frame of five beams."""

import math

# --- M8, ISO 68-1: its profile on a grid of angles and heights, so that facets run along the helix.

PITCH = 1.25e-3
MAJOR = 4e-3  # [m]  Radius of the bolt's crests.
DEPTH = 5 / 8 * math.sqrt(3) / 2 * PITCH
FACETS = 32  # Of a turn, and of a pitch.


def profile(step):
    """[m]  Radius of the bolt: a root of P/4, flanks of 30 degrees, a crest of P/8."""
    at = step % FACETS
    rise = min(1.0, max(0.0, (at - 8) / 10)) if at <= 22 else (FACETS - at) / 10
    return MAJOR - DEPTH * (1.0 - rise)


def thread(steps, wider):
    """Rings of points from z = 0 upwards: radius of the profile and `wider`."""
    return [[((profile(k - i) + wider) * math.cos(2 * math.pi * i / FACETS),
              (profile(k - i) + wider) * math.sin(2 * math.pi * i / FACETS), k * PITCH / FACETS)
             for i in range(FACETS)] for k in range(steps + 1)]


def tube(rings, is_inside):
    """Triangles between rings; their diagonals follow the helix."""
    faces = []
    for k in range(len(rings) - 1):
        for i in range(FACETS):
            a, b = k * FACETS + i, k * FACETS + (i + 1) % FACETS
            c, d = a + FACETS, b + FACETS
            faces += [(a, d, b), (a, c, d)] if is_inside else [(a, b, d), (a, d, c)]
    return faces


def write_obj(path, vertices, faces):
    with open(path, "w", encoding="utf-8") as out:
        out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices)
        out.writelines("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces)


def write_bolt(path, pitches):
    rings = thread(pitches * FACETS, 0.0)
    vertices = [point for ring in rings for point in ring]
    bottom, top = len(vertices), len(vertices) + 1
    last = (len(rings) - 1) * FACETS
    faces = tube(rings, False)
    for i in range(FACETS):
        j = (i + 1) % FACETS
        faces += [(bottom, j, i), (top, last + i, last + j)]
    write_obj(path, vertices + [(0.0, 0.0, 0.0), (0.0, 0.0, rings[-1][0][2])], faces)


def write_nut(path, pitches, wider):
    """`wider` is the radial gap to the bolt at the vertices; facets take at most 20 um of it."""
    rings = thread(pitches * FACETS, wider)
    vertices = [point for ring in rings for point in ring]
    faces = tube(rings, True)
    outside = len(vertices)
    height = rings[-1][0][2]
    for z in (0.0, height):
        vertices += [(7e-3 * math.cos(2 * math.pi * i / FACETS), 7e-3 * math.sin(2 * math.pi * i / FACETS), z)
                     for i in range(FACETS)]
    last = (len(rings) - 1) * FACETS
    for i in range(FACETS):
        j = (i + 1) % FACETS
        low, low_next, high, high_next = outside + i, outside + j, outside + FACETS + i, outside + FACETS + j
        faces += [(low, low_next, high_next), (low, high_next, high),
                  (i, j, low_next), (i, low_next, low), (last + i, high_next, last + j), (last + i, high, high_next)]
    write_obj(path, vertices, faces)


def nut_m8(folder):
    """A nut of five pitches on a bolt of eight with a head; to leave, it turns seven times."""
    write_bolt(folder / "bolt_m8.obj", 8)
    write_nut(folder / "nut_m8.obj", 5, 1e-4)
    return ([{"name": "head", "shape": {"box": {"size": [0.013, 0.013, 0.005]}}, "pose": {"position": [0, 0, -0.003]}},
             {"name": "base", "shape": {"mesh": str(folder / "bolt_m8.obj")}},
             {"name": "part", "shape": {"mesh": str(folder / "nut_m8.obj")}, "pose": {"position": [0, 0, PITCH]}}],
            {"position": [0, 0, 0.03]})


# --- Five beams of 60 mm in one plane, halved over each other. Walls of notches lean by 20 degrees.

HALF = 0.03
LEAN = math.tan(math.radians(20))


class Beam:
    """A beam along x at y = 0, of prisms."""

    def __init__(self):
        self.vertices = []
        self.faces = []

    def prism(self, ends, heights, end_leans=(0.0, 0.0), side_lean=0.0):
        """Between two x and two z; ends and sides are shifted by their lean times z."""
        first = len(self.vertices)
        for z in heights:
            for end, lean in zip(ends, end_leans):
                self.vertices += [(end + lean * z, y + side_lean * z, z) for y in (-HALF, HALF)]
        for a, b, c, d in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
            self.faces += [(first + a, first + b, first + c), (first + a, first + c, first + d)]

    def write(self, path, is_along_y, place):
        turned = [(-y, x, z) if is_along_y else (x, y, z) for x, y, z in self.vertices]
        write_obj(path, [(x + place[0], y + place[1], z) for x, y, z in turned], self.faces)


def halved(end, notches, gap):
    """A beam from -end to end with notches (middle, half that is cut away, lean).

    The lean is that of the walls of a notch above; of a notch below, that of the sides of the half
    that is left.
    """
    beam = Beam()
    at, lean_at = -end, 0.0
    for middle, cut, lean in [*sorted(notches), (end + HALF + gap, "none", 0.0)]:
        low, high = middle - HALF - gap, middle + HALF + gap
        lean_above = lean if cut == "above" else 0.0
        beam.prism((at, low), (-HALF, 0.0))
        beam.prism((at, low), (0.0, HALF), (lean_at, lean_above))
        if cut == "above":
            beam.prism((low, high), (-HALF, -gap / 2))
        elif cut == "below":
            beam.prism((low, high), (gap / 2, HALF), side_lean=lean)
        at, lean_at = high, lean_above
    return beam


def five_beams(folder, gap, is_locked=False):
    """Sills A and B, rails C and D across them, E across the rails; `gap` [m] between all walls.

    Returns what is taken away in turn: E, C, D, B. The ways out of E, C and D lean, each another way.
    Where it is locked, E leans one way at C and the other way at D: it would have to turn while it
    rises, and its notches do not let it turn.
    """
    sill = halved(0.3, [(0.2, "above", LEAN), (-0.2, "above", -LEAN)], gap)

    lean_at_d = -LEAN if is_locked else LEAN

    def rail(lean, lean_of_e):
        return halved(0.4, [(-0.3, "below", lean), (0.3, "below", lean), (0.0, "above", lean_of_e)], gap)

    # Beams that are turned onto y have their own y along -x.
    tie = halved(0.3, [(0.2, "below", -LEAN), (-0.2, "below", -lean_at_d)], gap)
    beams = {"A": (sill, True, (-0.3, 0.0)), "B": (sill, True, (0.3, 0.0)), "C": (rail(LEAN, LEAN), False, (0.0, 0.2)),
             "D": (rail(-LEAN, lean_at_d), False, (0.0, -0.2)), "E": (tie, True, (0.0, 0.0))}

    def body(name, beam):
        path = folder / f"beam_{beam}_{gap:g}.obj"
        shape, is_along_y, place = beams[beam]
        shape.write(path, is_along_y, place)
        return {"name": name, "shape": {"mesh": str(path)}, "pose": {"position": [0, 0, 0]}}

    found, left = {}, list("ABCDE")
    for moved in "ECDB":
        left.remove(moved)
        found[f"five beams, {moved}, {1e3 * gap:g} mm"] = (
            [body(f"beam {name}", name) for name in left] + [body("part", moved)],
            {"position": [0.1, 0.1, 0.4], "rpy": [0.1, 0.2, 0.3]})
    return found
