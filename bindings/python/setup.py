"""Builds the package: CMake makes the extension module, setuptools puts it into a wheel.

CMAKE_ARGS adds to the configuration. With -DFIRSTCONTACT_BUILD_VIEWER=ON (needs npm, which fetches
packages) the wheel holds the page that plays results.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BUILD = ROOT / "build" / "python"


class CMakeBuild(build_ext):
    """Runs CMake, and copies what it built into the package."""

    def build_extension(self, ext: Extension) -> None:
        ccache = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        ninja = ["-GNinja"] if shutil.which("ninja") else []
        subprocess.run(
            ["cmake", "--fresh", "-S", ROOT, "-B", BUILD, *ninja, *ccache, "-DCMAKE_BUILD_TYPE=Release",
             "-DFIRSTCONTACT_BUILD_PYTHON=ON", "-DFIRSTCONTACT_BUILD_APPS=OFF",
             "-DFIRSTCONTACT_BUILD_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}",
             *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--parallel", str(os.cpu_count()),
                        "--target", "firstcontact_python"], check=True)
        package = pathlib.Path(self.get_ext_fullpath(ext.name)).parent
        package.mkdir(parents=True, exist_ok=True)
        shutil.copy(*(BUILD / "python").glob("_core.*.so"), package)
        if "FIRSTCONTACT_BUILD_VIEWER:BOOL=ON" in (BUILD / "CMakeCache.txt").read_text():
            subprocess.run(["cmake", "--build", BUILD, "--target", "viewer"], check=True)
            shutil.copy(BUILD / "share/firstcontact/viewer.html", package)


def version() -> str:
    """As the library's CMake project says it."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(firstcontact VERSION ([0-9.]+)", text).group(1)


BUILD.mkdir(parents=True, exist_ok=True)
# Nothing is written beside the sources.
setup(version=version(),
      ext_modules=[Extension("firstcontact._core", sources=[])],
      cmdclass={"build_ext": CMakeBuild},
      options={"build": {"build_base": os.path.relpath(BUILD / "setuptools", HERE)},
               "egg_info": {"egg_base": os.path.relpath(BUILD, HERE)}})
