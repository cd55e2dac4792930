"""When do two moving bodies touch for the first time?

firstcontact answers for meshes, primitives, hulls and point clouds that turn and translate during a
step, and proves the answer: before the reported time the bodies are apart, at that time they are
within a tolerance that you choose.

    >>> import firstcontact as fc
    >>> ball = fc.make_sphere(0.5)
    >>> fall = fc.Motion.constant_velocity(fc.Pose((0, 0, 3)), translation=(0, 0, -4))
    >>> floor = fc.make_box((4, 4, 1))
    >>> result = fc.first_contact((ball, fall), (floor, fc.Motion.fixed()))
    >>> print(f"{result.verdict} at t = {result.t:.6f}")
    contact at t = 0.500000

Lengths are metres, angles radians, t runs from 0 to 1 over the step. Points are rows of n×3 arrays.
"""

from ._check import Answer, Pair, SceneLike, check, check_many, load_scene
from ._core import (BodySet, ClosestApproach, ClosestApproachResult, Contact, DistanceResult,
                    ElementaryContact, Feature, FirstContactResult, HapticSession,
                    HapticTick, LinearContact,
                    ManyBodiesWorkspace, MeshDefects, Motion, PairAnswer, PairRules, Pose, Result,
                    RobotModel, RobotScene, RunReader, RunStep, Scene, SceneClosest, SceneContact,
                    ScenePair, SceneResult, Shape, ShapeCache, Simulator, StopSource, Trajectory,
                    WorkCount, Workspace, __version__, answer_each_pair, closest_approach,
                    convex_hull, distance, edge_edge_contact, first_contact, inspect,
                    linear_edge_edge_contact, linear_vertex_face_contact, make_box, make_capsule,
                    make_cone, make_convex_hull, make_cylinder, make_ellipsoid, make_height_map, make_point_cloud,
                    make_sphere, move_vertices, parse_obj, parse_off, parse_pcd, parse_ply,
                    parse_ply_points, parse_scene, parse_stl, parse_xyz, read_heights, read_mesh,
                    read_mesh_file, read_points, read_points_file, read_request,
                    read_simulation_scene, read_srdf, read_trajectory, read_urdf, sample_gap,
                    verify_run, vertex_face_contact, weld, why_not_solid)
from ._errors import ParseError
from ._plan import EdgeChecker, plan
from ._reports import (FileReport, LeftOut, MeshReading, PairCounts, PointReading,
                       UntestedPairs)
from ._retime import retime
from ._run import Run, read_run
from ._simulate import simulate
from ._tuples import (ContactInterval, EdgeAnswers, EndEffector, GapPoints, GapSamples, HeightMap, HeldPair, Joint, JointTurn,
                      LimitViolation, Mesh, Mimic, MovingShape, PathVerification, PlanAnswer, PlanningRequest,
                      ProofMoment, RateUse, ResultVerification, RetimeAnswer, RetimedMoment, RobotGroup,
                      RobotSemantics, RunContacts, RunDevices, RunImpacts, RunMoment, RunTies, RunVerification)
from ._verify import verify_path, verify_result
from ._words import (Between, ContactState, ElementaryVerdict, FeatureType, Filling, JointLimit,
                     JointType, ProofVerdict, StartContacts, Turning, UndecidedReason, Verdict)

__all__ = [
    "Answer", "Between", "BodySet", "ClosestApproach", "ClosestApproachResult", "Contact", "ContactInterval",
    "ContactState", "DistanceResult", "EdgeAnswers", "EdgeChecker", "ElementaryContact", "ElementaryVerdict", "EndEffector",
    "Feature", "FeatureType", "FileReport", "Filling", "FirstContactResult", "GapPoints", "GapSamples",
    "HapticSession", "HapticTick", "HeightMap", "HeldPair", "Joint", "JointLimit", "JointTurn", "JointType", "LeftOut", "LimitViolation", "LinearContact",
    "ManyBodiesWorkspace", "Mesh", "MeshDefects", "MeshReading", "Mimic", "Motion",
    "MovingShape", "Pair", "PairAnswer", "PairCounts", "PairRules", "ParseError",
    "PathVerification", "PlanAnswer", "PlanningRequest", "PointReading", "Pose", "ProofMoment", "ProofVerdict", "RateUse",
    "Result", "ResultVerification", "RetimeAnswer", "RetimedMoment", "RobotGroup", "RobotModel", "RobotScene", "RobotSemantics", "Run", "RunContacts",
    "RunDevices", "RunImpacts", "RunMoment", "RunReader", "RunStep", "RunTies", "RunVerification", "Scene",
    "SceneClosest", "SceneContact", "SceneLike", "ScenePair", "SceneResult", "Shape", "ShapeCache", "Simulator",
    "StartContacts", "StopSource", "Trajectory", "Turning", "UndecidedReason", "UntestedPairs", "Verdict", "WorkCount", "Workspace",
    "__version__", "answer_each_pair", "check", "check_many", "closest_approach", "convex_hull",
    "distance", "edge_edge_contact", "first_contact", "inspect", "linear_edge_edge_contact",
    "linear_vertex_face_contact", "load_scene", "make_box", "make_capsule", "make_cone",
    "make_convex_hull", "make_cylinder", "make_ellipsoid", "make_height_map", "make_point_cloud", "make_sphere",
    "move_vertices", "parse_obj", "parse_off", "parse_pcd", "parse_ply", "parse_ply_points",
    "parse_scene", "parse_stl", "parse_xyz", "plan", "read_heights", "read_mesh", "read_mesh_file",
    "read_points", "read_points_file",
    "read_request", "read_run", "read_simulation_scene", "read_srdf", "read_trajectory", "read_urdf",
    "retime", "sample_gap", "simulate", "verify_path", "verify_result", "verify_run", "vertex_face_contact", "weld", "why_not_solid",
]

# People should see, and pickle, the names that they use.
for _name in __all__:
    if getattr(globals()[_name], "__module__", "").startswith("firstcontact._"):
        globals()[_name].__module__ = "firstcontact"
del _name
