"""Compares _nfr.pyi with the compiled module: the same names, parameters, defaults and documentation."""

import ast
import inspect
from pathlib import Path

import nfr


def parameters(function):
    """Names and defaults of a function in the stubs, as inspect.signature prints them."""
    arguments = function.args
    positional = [argument.arg for argument in arguments.args]
    defaults = [ast.unparse(value) for value in arguments.defaults]
    padded = [None] * (len(positional) - len(defaults)) + defaults
    named = [argument.arg for argument in arguments.kwonlyargs]
    only = [value and ast.unparse(value) for value in arguments.kw_defaults]
    stars = [argument.arg for argument in (arguments.vararg, arguments.kwarg) if argument]
    return [pair for pair in zip(positional + named, padded + only) if pair[0] not in ("self", "cls")], stars


def compiled_parameters(signature):
    pairs, stars = [], []
    for name, parameter in signature.parameters.items():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            stars.append(name)
        elif name != "self":
            pairs.append((name, None if parameter.default is parameter.empty else repr(parameter.default)))
    return pairs, stars


def check():
    tree = ast.parse(Path(nfr.__file__).with_name("_nfr.pyi").read_text())
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef) and hasattr(nfr, node.name)]
    assert {node.name for node in classes} == {name for name in vars(nfr._nfr) if not name.startswith("_")}
    for node in classes:
        compiled = getattr(nfr, node.name)
        assert ast.get_docstring(node) == inspect.getdoc(compiled), f"the documentation of {node.name} differs"
        members = {member.name: member for member in node.body if isinstance(member, ast.FunctionDef)}
        public = {name for name in vars(compiled) if not name.startswith("_")}
        assert {name for name in members if not name.startswith("_")} == public, f"the members of {node.name} differ"
        for name, member in members.items():
            where = f"{node.name}.{name}"
            if name == "__new__":
                assert compiled_parameters(inspect.signature(compiled)) == parameters(member), where
                continue
            value = getattr(compiled, name)
            assert ast.get_docstring(member) == inspect.getdoc(value), f"the documentation of {where} differs"
            if callable(value):
                assert compiled_parameters(inspect.signature(value)) == parameters(member), where
    print("the stubs are those of the module")


if __name__ == "__main__":
    check()
