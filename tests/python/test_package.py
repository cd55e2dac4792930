"""The package as people get it: typed, documented, complete in itself."""

import ast
import doctest
import inspect
import json
import os
import pathlib
import re
import subprocess
import sys

import firstcontact as fc
import pytest
from conftest import ROOT
from firstcontact import _core

STUB = ast.parse(pathlib.Path(fc.__file__).with_name("_core.pyi").read_text())


def stubtest_complaints() -> list[str]:
    run = subprocess.run([sys.executable, "-m", "mypy.stubtest", "--concise", "firstcontact._core"],
                         capture_output=True, text=True, timeout=300, check=False,
                         env={**os.environ, "MYPY_CACHE_DIR": os.devnull})
    assert "not checking" not in run.stdout + run.stderr, run.stdout + run.stderr
    # pybind11 gives its classes a metaclass, and those that nobody makes an __init__ that refuses.
    known = re.compile(r"metaclass differs$|\.__init__ is inconsistent, stub does not have \*args")
    assert run.stdout, run.stderr
    return [line for line in run.stdout.splitlines() if not known.search(line)]


def test_stubs_are_those_of_the_module():
    assert stubtest_complaints() == []


def test_package_passes_mypy_strictly(tmp_path):
    run = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", os.devnull,
                          "-p", "firstcontact"], capture_output=True, text=True, timeout=300,
                         check=False, cwd=tmp_path)
    assert run.returncode == 0, run.stdout


def test_types_are_seen_by_users(tmp_path):
    (tmp_path / "use.py").write_text(
        "import firstcontact as fc\n"
        "ball = fc.make_sphere(1.0)\n"
        "result = fc.first_contact((ball, fc.Motion.fixed()), (ball, fc.Motion.fixed()))\n"
        "reveal_type(result.verdict)\n"
        "reveal_type(ball.vertices.dtype)\n"
        "fc.first_contact(ball, ball)\n")
    run = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", os.devnull, "use.py"],
                         capture_output=True, text=True, timeout=300, check=False, cwd=tmp_path)
    assert "firstcontact._words.Verdict" in run.stdout and "numpy.dtype" in run.stdout
    assert "use.py:6: error: No overload variant" in run.stdout


def signatures_of_stub():
    """Of each function and method its arguments, overloads in their order."""
    found: dict[str, list[list[str]]] = {}

    def visit(nodes, prefix):
        for node in nodes:
            if isinstance(node, ast.ClassDef):
                visit(node.body, node.name + ".")
            elif isinstance(node, ast.FunctionDef) and not any(
                    isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list):
                names = [a.arg for a in (*node.args.args, *node.args.kwonlyargs) if a.arg != "self"]
                found.setdefault(prefix + node.name, []).append(names)

    visit(STUB.body, "")
    return found


def signatures_of(doc: str) -> list[list[str]]:
    """As pybind11 writes them."""
    lines = [line for line in doc.splitlines() if re.match(r"(\d\. )?\w+\(.*\) -> ", line)]
    return [[name for name in re.findall(r"(?:^|[(,] ?)(\w+): ", line) if name != "self"]
            for line in lines if "*args" not in line]


@pytest.mark.parametrize("name", [n for n in signatures_of_stub()
                                  if not re.search(r"__(eq|hash|len|getstate|setstate)__", n)])
def test_arguments_are_those_of_the_stub(name):
    function = _core
    for part in name.split("."):
        function = getattr(function, part)
    assert signatures_of(function.__doc__) == signatures_of_stub()[name]


@pytest.mark.parametrize("name", [n for n in fc.__all__ if callable(getattr(fc, n))
                                  and n not in ("Answer", "Pair", "SceneLike")])
def test_everything_has_a_docstring(name):
    thing = getattr(fc, name)
    assert thing.__module__ in ("firstcontact", "firstcontact._core") and inspect.getdoc(thing)


def test_first_example_of_the_package_holds():
    failed, run = doctest.testmod(fc)
    assert (failed, run) == (0, 6)


def test_a_fresh_environment_can_import_it(tmp_path):
    """With nothing but the wheel and Debian's numpy, from any folder."""
    wheels = list((ROOT / "build/wheel").glob("firstcontact-*.whl"))
    assert len(wheels) == 1, "tools/build_wheel makes it"
    venv = tmp_path / "venv"
    subprocess.run([sys._base_executable, "-m", "venv", "--system-site-packages", venv], check=True)
    python = venv / "bin/python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", wheels[0]],
                   check=True)
    script = ("import firstcontact as fc, json; ball = fc.make_sphere(1.0); "
              "print(json.dumps([fc.__file__, fc.distance((ball, fc.Motion.fixed()), "
              "(ball, fc.Motion.fixed(fc.Pose((3, 0, 0)))), 0.0).distance]))")
    run = subprocess.run([python, "-c", script], cwd=tmp_path, capture_output=True, text=True,
                         check=True)
    file, distance = json.loads(run.stdout)
    assert file.startswith(str(venv)) and distance == pytest.approx(1.0)


def test_version_is_that_of_the_library():
    assert re.search(rf"project\(firstcontact VERSION {re.escape(fc.__version__)} ",
                     (ROOT / "CMakeLists.txt").read_text())
