"""Modules that come into memory when something in them is asked for, and not when they are imported."""

import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from threading import RLock
from types import ModuleType
from typing import Any


def load_when_asked(names: Sequence[str]) -> None:
    """Do so with these modules, where they have not been imported before.

    The loader of the standard library does the same, but takes a look at the name of a module for a question;
    PySide looks at the names and files of all there are.
    """
    if not any(isinstance(each, _Finder) for each in sys.meta_path):
        sys.meta_path.insert(0, _Finder(names))


class _Finder(MetaPathFinder):
    """Finds some modules where they are and hands them to a loader that waits."""

    def __init__(self, names: Sequence[str]) -> None:
        self._names = frozenset(names)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path, target) if fullname in self._names else None
        if spec is not None and spec.loader is not None:
            spec.loader = _Waiting(spec.loader)
        return spec


class _Waiting(Loader):
    """Loads one module at its first question."""

    def __init__(self, loader: Loader) -> None:
        self._loader = loader
        self._lock = RLock()
        self._run = False

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return _Unasked(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        module.__dict__["__waiting__"] = self

    def asked(self, module: ModuleType) -> None:
        """Run the module; another thread waits for that, and the module itself may ask meanwhile."""
        with self._lock:
            if self._run:
                return
            self._run = True
            try:
                self._loader.exec_module(module)
            except BaseException:
                self._run = False
                raise
            module.__class__ = ModuleType


class _Unasked(ModuleType):
    """A module that has been imported and not yet run; names with two underscores are no question."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        self.__dict__["__waiting__"].asked(self)
        return ModuleType.__getattribute__(self, name)
