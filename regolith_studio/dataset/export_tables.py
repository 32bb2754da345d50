"""Tables that go with many exports: classes with their weights, and sizes with their shares."""

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.size_classes import size_classes
from regolith_studio.io.tables import csv_bytes

SIZE_COLUMNS = ("class", "name", "weight_number", "weight_mass", "diameter_um", "number_share", "mass_share")


def sizes_csv(dataset: Dataset) -> bytes:
    """One row a class and size: weights of the class, diameter, and its share within the class."""
    rows: list[tuple[object, ...]] = [SIZE_COLUMNS]
    by_number, by_mass = dataset.class_weights("number"), dataset.class_weights("volume")
    for index, one in enumerate(dataset.representatives):
        sizes = size_classes(one.sizes)
        for diameter, number, mass in zip(sizes.diameters, sizes.number, sizes.mass, strict=True):
            shares = (float(by_number[index]), float(by_mass[index]), float(diameter), float(number))
            rows.append((index, one.name, *shares, float(mass)))
    return csv_bytes(rows)


def shape_names(dataset: Dataset, prefix: str = "shape") -> list[str]:
    """Names without blanks or signs, in order: ``shape_00``, ``shape_01`` ..."""
    digits = max(2, len(str(len(dataset) - 1)))
    return [f"{prefix}_{index:0{digits}d}" for index in range(len(dataset))]
