"""Tables that go with many exports: classes with their weights, and sizes with their shares."""

from collections.abc import Iterable, Sequence

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.size_classes import size_classes

SIZE_COLUMNS = ("class", "name", "weight_number", "weight_mass", "diameter_um", "number_share", "mass_share")


def csv_bytes(header: Sequence[str], rows: Iterable[Sequence[object]]) -> bytes:
    """Comma-separated values, floats by ``repr``; text is quoted where it must be."""
    lines = [",".join(header), *(",".join(map(_cell, row)) for row in rows)]
    return ("\n".join(lines) + "\n").encode("utf-8")


def sizes_csv(dataset: Dataset) -> bytes:
    """One row a class and size: weights of the class, diameter, and its share within the class."""
    rows = []
    by_number, by_mass = dataset.class_weights("number"), dataset.class_weights("volume")
    for index, one in enumerate(dataset.representatives):
        sizes = size_classes(one.sizes)
        for diameter, number, mass in zip(sizes.diameters, sizes.number, sizes.mass, strict=True):
            shares = (float(by_number[index]), float(by_mass[index]), float(diameter), float(number))
            rows.append((index, one.name, *shares, float(mass)))
    return csv_bytes(SIZE_COLUMNS, rows)


def shape_names(dataset: Dataset, prefix: str = "shape") -> list[str]:
    """Names without blanks or signs, in order: ``shape_00``, ``shape_01`` ..."""
    digits = max(2, len(str(len(dataset) - 1)))
    return [f"{prefix}_{index:0{digits}d}" for index in range(len(dataset))]


def _cell(value: object) -> str:
    text = repr(value) if isinstance(value, float) else str(value)
    if any(sign in text for sign in ',"\n\r'):
        return '"' + text.replace('"', '""') + '"'
    return text
