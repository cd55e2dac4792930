"""Shapes take arrays and hand out views; bad arrays get clear complaints."""

import gc
import pickle
import sys

import firstcontact as fc
import numpy as np
import pytest
from conftest import ROOT, TRIANGLE, sphere

BUNNY = ROOT / "data/stanford/stanford-bunny.obj"


def shapes():
    cube = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return {
        "triangle": fc.Shape(TRIANGLE),
        "thick": fc.Shape(TRIANGLE, radius=0.125),
        "solid": fc.Shape(fc.convex_hull(cube), filling="solid"),
        "sphere": fc.make_sphere(0.5),
        "capsule": fc.make_capsule(0.5, 1),
        "box": fc.make_box((1, 2, 3)),
        "cylinder": fc.make_cylinder(0.5, 1, enclosure_error=1e-3),
        "cone": fc.make_cone(0.5, 1),
        "ellipsoid": fc.make_ellipsoid((0.5, 0.4, 0.3), enclosure_error=0.01),
        "hull": fc.make_convex_hull(cube, radius=0.25),
        "cloud": fc.make_point_cloud(cube, radius=0.1),
        "heights": fc.make_height_map(((0.5, 0.25), np.arange(12.0).reshape(3, 4))),
    }


@pytest.mark.parametrize("name", shapes())
def test_shape_pickles_as_the_same_shape(name):
    shape = shapes()[name]
    again = pickle.loads(pickle.dumps(shape))
    assert again == shape and hash(again) == hash(shape) and repr(again) == repr(shape)
    assert again.is_solid == shape.is_solid and again.radius == shape.radius
    assert again.enclosure_error == shape.enclosure_error
    assert again.is_curved == shape.is_curved == (name in ("cylinder", "cone", "ellipsoid"))
    np.testing.assert_array_equal(again.vertices, shape.vertices)


def test_shapes_differ():
    assert len({*shapes().values()}) == len(shapes())


def test_arrays_are_views_of_the_shape_itself():
    shape = sphere(1.0, 10)
    vertices, triangles = shape.mesh
    assert vertices.__array_interface__["data"] == shape.vertices.__array_interface__["data"]
    assert vertices.dtype == np.float64 and vertices.flags.c_contiguous
    assert triangles.dtype == np.uint32 and triangles.shape[1] == 3
    with pytest.raises(ValueError, match="read-only"):
        vertices[0, 0] = 1
    with pytest.raises(ValueError, match="WRITEABLE"):
        triangles.flags.writeable = True


def test_views_keep_the_shape_alive():
    shape = sphere(1.0, 40)
    copy = shape.vertices.copy()
    view = shape.vertices
    count = sys.getrefcount(shape)
    del view
    assert sys.getrefcount(shape) == count - 1
    view = shape.vertices
    del shape
    gc.collect()
    spare = [np.full_like(copy, 7.0) for _ in range(8)]  # Would take over memory that was freed.
    np.testing.assert_array_equal(view, copy)
    del spare


def test_any_numbers_make_a_mesh():
    expected = fc.Shape(TRIANGLE)
    vertices = np.asfortranarray(np.array(TRIANGLE[0], dtype=np.float32))
    for dtype in (np.int8, np.int64, np.uint16, np.uint64):
        assert fc.Shape((vertices[:, :], np.array(TRIANGLE[1], dtype=dtype))) == expected
    assert fc.Shape(fc.Mesh(np.array(TRIANGLE[0]), np.array(TRIANGLE[1], dtype=np.uint32))) == expected


@pytest.mark.parametrize("mesh, error, complaint", [
    (([[0, 0], [1, 0]], [[0, 1, 1]]), ValueError,
     r"vertices: expected an array of shape \(n, 3\), one point per row, got shape \(2, 2\)"),
    (([], []), ValueError, r"vertices: expected an array of shape \(n, 3\).*got shape \(0,\)"),
    ((np.zeros((0, 3)), np.zeros((0, 3), dtype=int)), ValueError, "triangle"),
    ((TRIANGLE[0], [[0.0, 1.0, 2.0]]), TypeError,
     "triangles: expected m×3 whole numbers, got an array of dtype float64"),
    ((TRIANGLE[0], [[0, 1, -1]]), ValueError, "triangles: expected rows .* from -1 to 1"),
    ((TRIANGLE[0], [[0, 1, 2**32]]), ValueError, "triangles: expected rows"),
    ((TRIANGLE[0], [[0, 1, 3]]), ValueError, "3"),
    ((np.array(TRIANGLE[0]) * 1j, TRIANGLE[1]), TypeError, "vertices: .* dtype complex128"),
    (([["a", "b", "c"]], [[0, 0, 0]]), TypeError, "vertices: .* dtype <U1"),
    (([[0, 0, np.nan], [1, 0, 0], [0, 1, 0]], TRIANGLE[1]), ValueError, "finite"),
    (([[0, 0, np.inf], [1, 0, 0], [0, 1, 0]], TRIANGLE[1]), ValueError, "finite"),
    (np.zeros((3, 3)), TypeError, r"mesh: expected a pair \(vertices, triangles\), got numpy"),
])
def test_bad_mesh_gets_a_clear_complaint(mesh, error, complaint):
    with pytest.raises(error, match=complaint):
        fc.Shape(mesh)


@pytest.mark.parametrize("make, complaint", [
    (lambda: fc.Shape(TRIANGLE, radius=-1), "radius"),
    (lambda: fc.Shape(TRIANGLE, radius=np.nan), "radius"),
    (lambda: fc.Shape(TRIANGLE, filling="solid"), "open edges"),
    (lambda: fc.Shape(TRIANGLE, filling="hollow"), 'Filling: expected one of "surface", "solid"'),
    (lambda: fc.make_sphere(0), "radius"),
    (lambda: fc.make_box((1, 2)), "size: expected 3 numbers"),
    (lambda: fc.make_point_cloud(np.zeros((0, 3))), "triangle|point"),
    (lambda: fc.convex_hull([[0, 0, np.nan]]), "finite"),
    (lambda: fc.make_height_map(((1, 1), [[1, 2, 3]])), "rows|heights|sample"),
    (lambda: fc.make_height_map(((1, 1), [1, 2, 3])), "heights: expected an array of two dim"),
])
def test_bad_shape_gets_a_clear_complaint(make, complaint):
    with pytest.raises(ValueError, match=complaint):
        make()


def test_reads_meshes_and_points(tmp_path):
    mesh = fc.read_mesh(BUNNY)
    assert mesh.vertices.shape[1] == 3 and len(mesh.triangles) > 60_000
    assert fc.read_mesh(str(BUNNY)).vertices.tobytes() == mesh.vertices.tobytes()
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0.1\nf 1 2 3\n"
    assert fc.parse_obj(text, "t").vertices[2, 2] == fc.parse_obj(text.encode(), "t").vertices[2, 2] == 0.1
    cloud = tmp_path / "cloud.xyz"
    np.savetxt(cloud, np.arange(12.0).reshape(4, 3))
    np.testing.assert_array_equal(fc.read_points(cloud), np.arange(12.0).reshape(4, 3))
    heights = tmp_path / "heights.txt"
    np.savetxt(heights, np.arange(6.0).reshape(2, 3))
    map = fc.read_heights(heights, cell=(0.5, 0.25))
    np.testing.assert_array_equal(map.heights, np.arange(6.0).reshape(2, 3))
    assert map.cell == (0.5, 0.25)
    assert fc.make_height_map(map) == fc.make_height_map(((0.5, 0.25), np.arange(6.0).reshape(2, 3)))


def test_arrays_of_readers_belong_to_the_caller():
    mesh = fc.read_mesh(BUNNY)
    mesh.vertices[:] *= 2.0
    assert fc.Shape(mesh).vertices[0, 0] == mesh.vertices[0, 0]


def test_file_errors(tmp_path):
    with pytest.raises(FileNotFoundError) as missing:
        fc.read_mesh(tmp_path / "none.obj")
    assert missing.value.filename == str(tmp_path / "none.obj")
    bad = tmp_path / "bad.obj"
    bad.write_text("v 0 0 0\nv 1 zero 0\n")
    with pytest.raises(fc.ParseError) as parse:
        fc.read_mesh(bad)
    assert (parse.value.path, parse.value.line) == (str(bad), 2)
    assert str(parse.value) == f"{bad}:2: {parse.value.message}"
    again = pickle.loads(pickle.dumps(parse.value))
    assert isinstance(again, ValueError) and str(again) == str(parse.value) and again.line == 2


def test_inspection():
    doubled = (TRIANGLE[0] + TRIANGLE[0], [[0, 1, 2], [3, 4, 5]])
    welded = fc.weld(doubled)
    assert welded.triangles.tolist() == [[0, 1, 2], [0, 1, 2]]
    defects = fc.inspect(welded)
    assert (defects.doubled_triangles, defects.open_edges, defects.signed_volume) == (1, 0, None)
    np.testing.assert_array_equal(defects.bounds, [[0, 0, 0], [1, 1, 0]])
    assert fc.why_not_solid(TRIANGLE) == "3 open edges"
    box = fc.make_box((1, 2, 3))
    assert fc.inspect(box.mesh).signed_volume == 6.0 and fc.why_not_solid(box.mesh) == ""


def test_features_by_number(triangle):
    assert triangle.edge_count == 3
    assert sorted(triangle.edge(k) for k in range(3)) == [(0, 1), (0, 2), (1, 2)]
    with pytest.raises(IndexError):
        triangle.edge(3)


def test_vertices_move_on_lines(triangle):
    to = triangle.vertices + [[0, 0, -2], [0, 0, -2], [0, 0, -4]]
    up = fc.Motion.fixed(fc.Pose((0.1, 0.1, -1)))
    moving = fc.move_vertices(triangle, to)
    # At (0.1, 0.9), which both have, it falls by (0.1 2 + 0.9 4) t onto what waits 1 m below.
    result = fc.first_contact(moving, (triangle, up), tolerance=1e-9)
    assert result.verdict == "contact" and result.t == pytest.approx(1 / 3.8, abs=1e-8)
    assert pickle.loads(pickle.dumps(moving.X_WS)) == moving.X_WS
    with pytest.raises(TypeError, match="pickle what move_vertices was given"):
        pickle.dumps(moving.shape)
    with pytest.raises(ValueError, match="a place for each of the 3 vertices, got 2"):
        fc.move_vertices(triangle, to[:2])
