"""Files of spherical-harmonics coefficients as other programs print them."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from regolith_studio.errors import FileError, GeometryError, InputError
from regolith_studio.geometry.particle import Particle, Source
from regolith_studio.harmonics.coefficients import ShCoefficients
from regolith_studio.harmonics.io import from_complex_rows, from_shtools_rows
from regolith_studio.readers.error_messages import lower_first, message_about, plural
from regolith_studio.readers.sandbox.parent import sha256_of, shared_sandbox
from regolith_studio.readers.settings import unit_factor

__all__ = ["CoefficientFile", "TableConvention", "read_coefficients"]

TableConvention = Literal["auto", "complex", "shtools-4pi", "shtools-ortho"]
CONVENTIONS: tuple[TableConvention, ...] = get_args(TableConvention)

_HEADER_LINES = 2
"""SHTOOLS' files may begin with two."""
_GUESSED = (
    "Interpreted as a table of SHTOOLS in its usual normalisation (4 pi), since commas separate its columns."
)


@dataclass(frozen=True)
class TableReading:
    """How tables are read: the degree above which coefficients are left out, and their convention."""

    l_max: int | None = None
    convention: TableConvention = "auto"


def table_convention(text: str) -> TableConvention:
    """The convention that a user names.

    Raises InputError if there is none of that name.
    """
    for convention in CONVENTIONS:
        if text == convention:
            return convention
    raise InputError(f"There is no convention “{text}”; there are {', '.join(CONVENTIONS)}.")


@dataclass(frozen=True)
class CoefficientFile:
    """One particle's coefficients in micrometres, and where they come from."""

    name: str
    coefficients: ShCoefficients
    source: Source
    notes: tuple[str, ...] = ()


def read_coefficients(
    path: str | Path,
    unit: str = "um",
    *,
    convention: TableConvention = "auto",
) -> CoefficientFile:
    """The radius function of one particle, from rows ``l m Re Im`` or ``l, m, C, S``.

    - ``path``: text with four columns; more are ignored (SHTOOLS adds errors).
    - ``unit``: unit of the radius.
    - ``convention``: ``complex``: orthonormal complex harmonics with the Condon-Shortley phase, as the
      particle tables of NIST lineage have them. ``shtools-4pi``, ``shtools-ortho``: real ones without the
      phase. ``auto``: complex if there are rows of m < 0, SHTOOLS with 4 pi if commas separate.

    Raises FileError with one sentence if the file is no such table, rows are missing or not finite, or its
    convention is ambiguous. Raises InputError if there is no such unit.
    """
    factor = unit_factor(unit)
    path = Path(path)
    answer = shared_sandbox().request("numbers", path, headers=_HEADER_LINES)
    rows = answer.arrays[0]
    try:
        if rows.shape[1] < 4:
            points = " Points alone enclose no particle." if rows.shape[1] == 3 else ""
            columns = plural(rows.shape[1], "column")
            raise InputError(f"has {columns}; a table of coefficients has four: l m Re Im.{points}")
        notes: tuple[str, ...] = ()
        if convention == "auto":
            convention = _convention(rows, bool(answer.header["commas"]))
            notes = (_GUESSED,) if convention != "complex" else ()
        coefficients = _coefficients(_without_header(rows[:, :4]), convention)
        if not coefficients.values[0] > 0.0:
            raise InputError("has no positive mean radius: its row l = 0, m = 0 is missing or not positive.")
    except InputError as error:
        raise FileError(message_about(path, _as_predicate(str(error)))) from None
    source = Source(str(path), sha256_of(path), unit)
    return CoefficientFile(path.stem, coefficients.scaled(factor), source, notes)


def _convention(rows: np.ndarray, commas: bool) -> TableConvention:
    if (rows[:, 1] < 0).any():
        return "complex"
    if commas:
        return "shtools-4pi"
    raise InputError(
        "does not show its convention: rows of m < 0 would say complex, commas between the columns SHTOOLS; "
        "add either, or name the convention (--convention)."
    )


def _coefficients(rows: np.ndarray, convention: TableConvention) -> ShCoefficients:
    if convention == "complex":
        return from_complex_rows(rows)
    if convention in ("shtools-4pi", "shtools-ortho"):
        return from_shtools_rows(rows, convention.removeprefix("shtools-"))
    raise InputError(f"cannot be read in the convention “{convention}”, which is not known.")


def _without_header(rows: np.ndarray) -> np.ndarray:
    """SHTOOLS' header lines are numbers too: reference radius, constants, degrees."""
    for _ in range(_HEADER_LINES):
        degree, order = rows[0, :2]
        if len(rows) > 1 and np.isfinite(rows[0]).all() and (degree % 1 or order % 1 or abs(order) > degree):
            rows = rows[1:]
    return rows


def _as_predicate(sentence: str) -> str:
    """The error of a check as the end of a sentence that begins with the file's name."""
    if sentence.startswith(("has ", "does ", "cannot ")):
        return sentence
    return f"is not a valid table of coefficients: {lower_first(sentence)}"


TABLE_SUFFIXES = (".anm", ".sh", ".shc")
"""Suffixes of tables of coefficients."""

TEXT_SUFFIXES = (".txt", ".dat", ".tab", ".csv")
"""Suffixes of text files that may be such tables if named explicitly; ignored in folders."""

DEFAULT_TABLE_READING = TableReading()

_FINE_DEGREE = 16
"""Above it 2,562 vertices do not resolve the coefficients."""


def read_table_particle(
    path: Path,
    unit: str,
    group: str = "",
    tables: TableReading = DEFAULT_TABLE_READING,
) -> Particle:
    """The particle that a table of coefficients describes, about its star point.

    Its mesh has 5,120 faces, or 20,480 where the degree is above 16, and the volume of the smooth surface.

    Raises FileError with one sentence if the file is no such table. Raises GeometryError with one sentence
    if its surface passes through its centre.
    """
    from regolith_studio.harmonics.synthesis import reconstruct

    l_max = tables.l_max
    table = read_coefficients(path, unit, convention=tables.convention)
    coefficients, notes = table.coefficients, table.notes
    if l_max is not None and l_max < coefficients.l_max:
        notes += (
            f"Coefficients above l = {l_max} are left out; its table has them up to {coefficients.l_max}.",
        )
        coefficients = coefficients.truncated(l_max)
    try:
        mesh = reconstruct(coefficients, level=5 if coefficients.l_max > _FINE_DEGREE else 4)
    except GeometryError as error:
        raise GeometryError(message_about(path, f"holds no particle: {lower_first(str(error))}")) from None
    return Particle(table.name, mesh, group, replace(table.source, l_max=l_max), notes)
