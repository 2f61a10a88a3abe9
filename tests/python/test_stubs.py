"""The types that the package states of its extension."""

import ast
import pathlib
import re

import glint
from glint import _glint


def test_stubs_name_the_extensions_functions_and_arguments():
    text = (pathlib.Path(glint.__file__).parent / "_glint.pyi").read_text()
    stated = {node.name: [argument.arg for argument in node.args.args]
              for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)}
    actual = {}
    for name in dir(_glint):
        if not name.startswith("__"):
            signature = getattr(_glint, name).__doc__.splitlines()[0]
            actual[name] = re.findall(r"[(,] ?(\w+):", signature)
    assert stated == actual
    assert (pathlib.Path(glint.__file__).parent / "py.typed").exists()


def test_all_that_is_public_is_documented():
    for name in glint.__all__:
        value = getattr(glint, name)
        if callable(value):
            assert value.__doc__, name
            for method in vars(value) if isinstance(value, type) else ():
                if not method.startswith("_") and callable(getattr(value, method)):
                    assert getattr(value, method).__doc__, f"{name}.{method}"
