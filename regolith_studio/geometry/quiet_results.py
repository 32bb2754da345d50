"""What kernels return becomes Python's without a line of Python running.

A signal that comes while a kernel runs is handled at the next line of Python. Numba makes arrays and named
tuples by such lines, and does not ask whether they have succeeded: where Ctrl+C raised its exception in one
of them, the interpreter ended with a segmentation fault. Here classes are taken from the constants of the
compiled code and only C is called, so the exception comes out of the line that called the kernel.
"""

import copy
from importlib import import_module
from typing import Any

pythonapi: Any = import_module("numba.core.pythonapi")
boxing: Any = import_module("numba.core.boxing")
types: Any = import_module("numba").types


def _array(kind: Any, value: Any, c: Any) -> Any:
    """Code for an array as numba makes it, of which the class is a constant instead of unpickled."""
    quiet = copy.copy(c.pyapi)
    quiet.serialize_object = lambda made: made
    quiet.unserialize = lambda made: _constant(made, c)
    return boxing.box_array(kind, value, c._replace(pyapi=quiet))


def _named_tuple(kind: Any, value: Any, c: Any) -> Any:
    """Code for ``tuple.__new__(class, values)``."""
    values, new, made = (
        boxing.box_tuple(kind, value, c),
        _constant(tuple.__new__, c),
        _constant(kind.instance_class, c),
    )
    named = c.pyapi.call_function_objargs(new, (made, values))
    for each in (values, new, made):
        c.pyapi.decref(each)
    return named


def _constant(made: Any, c: Any) -> Any:
    """Code for a new reference to an object that is stored beside the compiled code."""
    constant = c.env_manager.read_const(c.env_manager.add_const(made))
    c.pyapi.incref(constant)
    return constant


def return_quietly() -> None:
    """Let numba do so; it has no public way to replace its own, which is left where that is not found."""
    functions: Any = getattr(getattr(pythonapi, "_boxers", None), "functions", {})
    for kind, code in (
        (types.Array, _array),
        (types.NamedTuple, _named_tuple),
        (types.NamedUniTuple, _named_tuple),
    ):
        if kind in functions:
            functions[kind] = code
