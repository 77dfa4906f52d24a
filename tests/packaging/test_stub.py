"""The stub of the compiled core says what the binary has."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import inspect
from pathlib import Path

import corota
from corota import _core

STUB = Path(corota.__file__).with_name("_core.pyi")


def declared() -> dict[str, ast.stmt]:
    """Public names of the stub and the statements that declare them."""
    names: dict[str, ast.stmt] = {}
    for node in ast.parse(STUB.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names[node.name] = node
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names[node.target.id] = node
    return {name: node for name, node in names.items() if not name.startswith("_")}


def compiled() -> set[str]:
    return {name for name in dir(_core) if not name.startswith("_")}


def stub_arguments(function: ast.FunctionDef) -> list[str]:
    arguments = function.args
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    return [a.arg for a in every if a.arg not in ("self", "cls")]


def binary_arguments(function: object) -> list[str]:
    signature = inspect.signature(function)  # type: ignore[arg-type]
    return [name for name in signature.parameters if name not in ("self", "cls")]


def methods(node: ast.ClassDef) -> dict[str, ast.FunctionDef]:
    return {m.name: m for m in node.body if isinstance(m, ast.FunctionDef)}


def test_stub_and_binary_have_the_same_names() -> None:
    assert set(declared()) == compiled()


def test_functions_have_the_declared_arguments() -> None:
    functions = {k: v for k, v in declared().items() if isinstance(v, ast.FunctionDef)}
    assert functions or any(isinstance(v, ast.ClassDef) for v in declared().values())
    for name, node in functions.items():
        assert binary_arguments(getattr(_core, name)) == stub_arguments(node), name


def test_classes_have_the_declared_members_and_arguments() -> None:
    for name, node in declared().items():
        if not isinstance(node, ast.ClassDef):
            continue
        cls = getattr(_core, name)
        public = {m for m in vars(cls) if not m.startswith("_")}
        attributes = {
            item.target.id
            for item in node.body
            if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
        }
        stub = {m for m in methods(node) if not m.startswith("_")} | attributes
        assert stub == public, name
        for method, function in methods(node).items():
            decorated = {ast.unparse(d) for d in function.decorator_list}
            if "property" in decorated or method.startswith("_"):
                continue
            found = binary_arguments(getattr(cls, method))
            assert found == stub_arguments(function), f"{name}.{method}"
