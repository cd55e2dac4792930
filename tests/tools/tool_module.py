"""Loads a script of tools/, which has no ending, as a module."""

import importlib.machinery
import importlib.util
import pathlib
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent


def load_tool(name: str):
    sys.dont_write_bytecode = True  # Nothing is left beside the script.
    loader = importlib.machinery.SourceFileLoader(name, str(PROJECT / "tools" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module
