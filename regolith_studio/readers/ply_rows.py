"""The rows of a PLY file: tables of numbers and ragged lists, binary and ASCII."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from regolith_studio.errors import FileError
from regolith_studio.readers.ply_header import Element, Property


@dataclass
class Columns:
    """The columns of one element: numbers, shape (count,), and lists as flat values with their sizes."""

    numbers: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    lists: dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]] = field(default_factory=dict)


def binary_columns(data: bytes, place: int, element: Element, order: str) -> tuple[Columns, int]:
    """The element's columns and the place after it; `order` is ``"<"`` or ``">"``.

    Raises
    ------
    FileError
        If the rows go beyond the end of the file.
    """
    if element.count == 0:
        return _empty(element), place
    regular = _regular_dtype(data, place, element, order)
    end = place + element.count * regular.itemsize
    if end <= len(data):
        table = np.frombuffer(data, dtype=regular, count=element.count, offset=place)
        if all(
            (table[f"n{i}"] == table[f"n{i}"][0]).all()
            for i, p in enumerate(element.properties)
            if p.counted_by
        ):
            return _from_table(table, element), end
    if not any(p.counted_by for p in element.properties):
        raise _cut_short(element)
    return _walked(data, place, element, order)


def ascii_columns(words: list[bytes], place: int, element: Element) -> tuple[Columns, int]:
    """The element's columns and the index of the word after it.

    Raises
    ------
    FileError
        If words are missing or are no numbers.
    """
    if element.count == 0:
        return _empty(element), place
    try:
        if not any(p.counted_by for p in element.properties):
            width = len(element.properties)
            end = place + element.count * width
            if end > len(words):
                raise _cut_short(element)
            table = np.array([float(word) for word in words[place:end]]).reshape(element.count, width)
            return Columns({p.name: table[:, i] for i, p in enumerate(element.properties)}), end
        return _walked_words(words, place, element)
    except ValueError:
        raise FileError(
            f"is not a proper PLY: a row of “{element.name}” holds something else than numbers."
        ) from None


def trimmed_rows(lines: list[list[bytes]], elements: tuple[Element, ...]) -> list[bytes] | None:
    """The words that the header asks for, a row a line; ``None`` if a line has fewer."""
    words: list[bytes] = []
    if sum(element.count for element in elements) > len(lines):
        return None
    rows = iter(lines)
    for element in elements:
        for _ in range(element.count):
            row, needed = next(rows), 0
            for p in element.properties:
                if needed >= len(row) or (p.counted_by and not row[needed].isdigit()):
                    return None
                needed += 1 + int(row[needed]) if p.counted_by else 1
            if needed > len(row):
                return None
            words += row[:needed]
    return words


def _empty(element: Element) -> Columns:
    columns = Columns()
    for p in element.properties:
        if p.counted_by:
            columns.lists[p.name] = (np.zeros(0), np.zeros(0, dtype=np.int64))
        else:
            columns.numbers[p.name] = np.zeros(0)
    return columns


def _cut_short(element: Element) -> FileError:
    return FileError(
        f"is cut short: it ends before the {element.count:,} rows of “{element.name}” that it promises; "
        "copy or export it again."
    )


def _regular_dtype(data: bytes, place: int, element: Element, order: str) -> np.dtype[np.void]:
    """The record of a row if all rows' lists are as long as those of the first."""
    fields: list[tuple[str, str, tuple[int, ...]]] = []
    for i, p in enumerate(element.properties):
        if p.counted_by:
            size = _count_at(data, place, order + p.counted_by, element)
            fields.append((f"n{i}", order + p.counted_by, ()))
            place += np.dtype(p.counted_by).itemsize + size * np.dtype(p.kind).itemsize
            fields.append((f"v{i}", order + p.kind, (size,)))
        else:
            place += np.dtype(p.kind).itemsize
            fields.append((f"v{i}", order + p.kind, ()))
    return np.dtype(fields)


def _count_at(data: bytes, place: int, kind: str, element: Element) -> int:
    width = np.dtype(kind).itemsize
    if place + width > len(data):
        raise _cut_short(element)
    count = int.from_bytes(
        data[place : place + width], "little" if kind[0] == "<" else "big", signed=kind[1] == "i"
    )
    if place + width + count > len(data):
        raise _cut_short(element)
    if count < 0:
        raise FileError(f"is not a proper PLY: a row of “{element.name}” has a list of {count:,} values.")
    return count


def _from_table(table: NDArray[np.void], element: Element) -> Columns:
    columns = Columns()
    for i, p in enumerate(element.properties):
        values = table[f"v{i}"]
        if p.counted_by:
            sizes = np.full(len(table), values.shape[1], dtype=np.int64)
            columns.lists[p.name] = (values.astype(np.float64).ravel(), sizes)
        else:
            columns.numbers[p.name] = values.astype(np.float64)
    return columns


def _walked(data: bytes, place: int, element: Element, order: str) -> tuple[Columns, int]:
    """Row by row, where lists differ in length."""
    numbers: dict[str, list[float]] = {p.name: [] for p in element.properties if not p.counted_by}
    values: dict[str, list[bytes]] = {p.name: [] for p in element.properties if p.counted_by}
    sizes: dict[str, list[int]] = {name: [] for name in values}
    for _ in range(element.count):
        for p in element.properties:
            count = 1
            if p.counted_by:
                count = _count_at(data, place, order + p.counted_by, element)
                place += np.dtype(p.counted_by).itemsize
                sizes[p.name].append(count)
            end = place + count * np.dtype(p.kind).itemsize
            if end > len(data):
                raise _cut_short(element)
            if p.counted_by:
                values[p.name].append(data[place:end])
            else:
                numbers[p.name].append(float(np.frombuffer(data, order + p.kind, 1, place)[0]))
            place = end
    kinds = {p.name: order + p.kind for p in element.properties}
    return Columns(
        {name: np.array(column) for name, column in numbers.items()},
        {
            name: (
                np.frombuffer(b"".join(parts), kinds[name]).astype(np.float64),
                np.array(sizes[name], dtype=np.int64),
            )
            for name, parts in values.items()
        },
    ), place


def _walked_words(words: list[bytes], place: int, element: Element) -> tuple[Columns, int]:
    numbers: dict[str, list[float]] = {p.name: [] for p in element.properties if not p.counted_by}
    values: dict[str, list[float]] = {p.name: [] for p in element.properties if p.counted_by}
    sizes: dict[str, list[int]] = {name: [] for name in values}
    for _ in range(element.count):
        for p in element.properties:
            if place >= len(words):
                raise _cut_short(element)
            if p.counted_by:
                place = _take_list(words, place, p, values[p.name], sizes[p.name], element)
            else:
                numbers[p.name].append(float(words[place]))
                place += 1
    columns = Columns({name: np.array(column) for name, column in numbers.items()})
    for name, flat in values.items():
        columns.lists[name] = (np.array(flat, dtype=np.float64), np.array(sizes[name], dtype=np.int64))
    return columns, place


def _take_list(
    words: list[bytes], place: int, p: Property, values: list[float], sizes: list[int], element: Element
) -> int:
    count = int(words[place])
    end = place + 1 + count
    if count < 0 or end > len(words):
        raise FileError(
            f"is not a proper PLY: row {len(sizes):,} of “{element.name}” promises “{p.name[:30]}” with "
            f"{count:,} values, and the file ends before."
        )
    values += [float(word) for word in words[place + 1 : end]]
    sizes.append(count)
    return end
