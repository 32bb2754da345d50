"""Look-up of everything that comes in kinds: coarsening methods, exporters, DEM engines, readers, pages ...

A kind is one module of its folder that defines a row (``METHOD``, ``EXPORTER``, ``FORMAT`` ...), or one entry
point of another installed package, which names such a row::

    [project.entry-points."regolith_studio.exporters"]
    abaqus = "my_package.abaqus:EXPORTER"

Groups: ``regolith_studio.coarsening_methods``, ``.exporters``, ``.engines``, ``.shape_models``, ``.readers``
(meshes), ``.volume_readers``, ``.position_readers`` and ``.pages``.
"""

import logging
import pkgutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from inspect import Parameter, isclass, signature
from typing import Any, Generic, TypeVar

T = TypeVar("T")

_log = logging.getLogger(__name__)
_problems: dict[tuple[str, str], str] = {}


def plugin_problems() -> tuple[str, ...]:
    """One sentence for each entry point that could not be used, of the registries asked so far."""
    return tuple(_problems.values())


class Registry(Mapping[str, T], Generic[T]):
    """The rows of one kind by their ``key``; collected at the first look-up, not when imported.

    A row of another package is left out, with a line in the log and a sentence in :func:`plugin_problems`, if
    it cannot be imported, is no such row, or has the key of a row that is there already.

    - ``package``: dotted name of the folder whose modules are looked through.
    - ``attribute``: name of the row in a module, ``METHOD`` say; modules without it hold no row.
    - ``group``: of the entry points, without the leading ``regolith_studio.``.
    - ``order``: sorting key of a row. Without one the rows stand in the order of the modules' names, and
      those of other packages after them.
    """

    def __init__(
        self, package: str, attribute: str, group: str, order: Callable[[T], Any] | None = None
    ) -> None:
        self._package, self._attribute, self._order = package, attribute, order
        self._group = f"regolith_studio.{group}"

    def __getitem__(self, key: str) -> T:
        return self._rows[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    @cached_property
    def _rows(self) -> dict[str, T]:
        rows = self._own_rows()
        required = _shared_names(rows.values())
        arguments = _shared_arguments(rows.values(), required)
        for entry in sorted(entry_points(group=self._group)):
            try:
                self._add(entry, rows, required, arguments)
            except (Exception, SystemExit) as error:  # noqa: BLE001 (whatever it raises, the rest must work)
                reason = str(error) or type(error).__name__
                sentence = f"The plug-in {_title(entry)} cannot be used: {reason.rstrip('.')}."
                _problems[self._group, entry.name] = sentence
                _log.warning(sentence)
        if self._order is not None:
            order = self._order
            rows = dict(sorted(rows.items(), key=lambda item: order(item[1])))
        return rows

    def _own_rows(self) -> dict[str, T]:
        folder = import_module(self._package).__path__
        names = sorted(module.name for module in pkgutil.iter_modules(folder))
        modules = [import_module(f"{self._package}.{name}") for name in names]
        rows = [getattr(module, self._attribute) for module in modules if hasattr(module, self._attribute)]
        return {str(row.key): row for row in rows}

    def _add(
        self, entry: EntryPoint, rows: dict[str, T], required: set[str], arguments: dict[str, list[str]]
    ) -> None:
        """Add the row of an entry point, which must have what all own rows have; what is wrong is raised."""
        row = entry.load()
        key = row.key
        if not isinstance(key, str) or not key:
            raise TypeError("its key must be a text")
        if key in rows:
            raise ValueError(f"there is a {self._attribute} {key!r} already")
        if missing := sorted(required - set(dir(row))):
            raise TypeError(f"it has no {missing[0]!r}")
        for name, taken in arguments.items():
            _check_arguments(name, getattr(row, name), taken)
        if self._order is not None:
            self._order(row)
        rows[key] = row


def _title(entry: EntryPoint) -> str:
    package = entry.dist.name if entry.dist is not None else ""
    return f"{entry.name!r} ({entry.value}{f' of {package}' if package else ''}, group {entry.group})"


def _shared_names(rows: Iterable[object]) -> set[str]:
    """Public attributes that all rows have."""
    names = [{name for name in dir(row) if not name.startswith("_")} for row in rows]
    return set.intersection(*names) if names else set()


def _shared_arguments(rows: Iterable[object], names: set[str]) -> dict[str, list[str]]:
    """Positional arguments of each function that all rows have; of the row that takes the fewest."""
    found: dict[str, list[str]] = {}
    for name in sorted(names):
        values = [getattr(row, name) for row in rows]
        if all(callable(value) and not isclass(value) for value in values):
            found[name] = min(map(_positional, values), key=len)
    return found


def _positional(function: Callable[..., Any]) -> list[str]:
    kinds = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
    taken = signature(function).parameters.values()
    return [each.name.lstrip("_") for each in taken if each.kind in kinds]


def _check_arguments(name: str, function: Callable[..., Any], taken: list[str]) -> None:
    try:
        signature(function).bind(*taken)
    except TypeError:
        raise TypeError(f"its {name!r} must take {len(taken)} arguments ({', '.join(taken)})") from None
