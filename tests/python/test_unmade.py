"""Objects that `__new__` alone has made hold nothing: each use of them raises an error."""

import inspect

import firstcontact as fc
import pytest
from firstcontact import _core

CLASSES = [value for _, value in inspect.getmembers(_core, inspect.isclass)
           if "pybind11" in type(value).__name__]
REFUSAL = "made by __new__ alone"


def test_a_session_refuses_to_step():
    session = fc.HapticSession.__new__(fc.HapticSession)
    with pytest.raises(TypeError, match=REFUSAL):
        session.step([fc.Pose((0, 0, 0))])
    with pytest.raises(TypeError, match=REFUSAL):
        fc.HapticSession.step(session, [fc.Pose((0, 0, 0))])


def test_functions_refuse_such_arguments():
    ball = fc.make_sphere(1.0)
    with pytest.raises(TypeError, match=REFUSAL):
        fc.first_contact((fc.Shape.__new__(fc.Shape), fc.Motion.fixed()), (ball, fc.Motion.fixed()))
    with pytest.raises(TypeError, match=REFUSAL):
        fc.Motion.constant_velocity(fc.Pose.__new__(fc.Pose), translation=(0, 0, 1))


def test_all_classes_are_found():
    assert len(CLASSES) > 30
    assert {fc.HapticSession, fc.Shape, fc.Pose, fc.Scene} <= set(CLASSES)


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_properties_refuse(kind):
    thing = kind.__new__(kind)
    properties = [name for name, value in vars(kind).items()
                  if type(value) is property and value.fget is not None]
    for name in properties:
        with pytest.raises(TypeError):
            getattr(thing, name)
    if "__repr__" in vars(kind):
        with pytest.raises(TypeError):
            repr(thing)


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_methods_refuse(kind):
    thing = kind.__new__(kind)
    for name, value in vars(kind).items():
        if not name.startswith("__") and callable(value) and not isinstance(value, (type, staticmethod)):
            with pytest.raises(TypeError):
                value(thing)


class Derived(fc.Pose):
    def __init__(self, is_made):
        if is_made:
            super().__init__((1, 2, 3))


def test_derived_classes_are_made_by_their_init():
    assert list(Derived(True).position) == [1, 2, 3]
    with pytest.raises(TypeError, match="__init__"):
        Derived(False)
