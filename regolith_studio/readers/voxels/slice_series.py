"""Which files of a folder belong to one volume: a DICOM series, a Zarr hierarchy, a series of slices.

The names of such slices differ in one number, which counts them.
"""

import math
import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise, takewhile
from pathlib import Path

from regolith_studio.errors import FileError
from regolith_studio.io.file_names import natural_key
from regolith_studio.readers.error_messages import plural, printable

SLICE_SUFFIXES = (".tif", ".tiff", ".png", ".bmp")
MIN_SLICES = 3
MAX_SLICES = 100_000
MIN_HEX_DENSITY = 0.5
"""Share of a range that hexadecimal counters fill, or they are words of the letters a to f."""
_NUMBER = re.compile(r"([+-]?\d+)")
_HEX = re.compile(r"[0-9a-f]+|[0-9A-F]+")


@dataclass(frozen=True)
class SliceSeries:
    """Images that are slices of one scan.

    ``name``: of the files, with ``#`` in place of the number that counts them. ``files``, ``numbers``: names
    and their numbers, in the order of the latter.
    """

    name: str
    files: tuple[str, ...]
    numbers: tuple[int, ...]

    @property
    def step(self) -> int:
        """The largest number by multiples of which the slices are counted."""
        return math.gcd(*(b - a for a, b in pairwise(self.numbers))) or 1

    @property
    def missing(self) -> tuple[int, ...]:
        """The numbers that no slice has, at most one more than the slices."""
        present, counted = set(self.numbers), range(self.numbers[0], self.numbers[-1], self.step)
        most = len(present) + 1
        return tuple(
            number for number, _ in zip((n for n in counted if n not in present), range(most), strict=False)
        )

    def in_place(self, allow_gaps: bool) -> list[str | None]:
        """Names of the slices from the first to the last, None for those that are absent.

        Raises FileError if some are, and that is not allowed, or two have one number.
        """
        for (first, second), (a, b) in zip(pairwise(self.files), pairwise(self.numbers), strict=True):
            if a == b:
                raise FileError(
                    f"has two slices of the number {a}: {printable(first)} and {printable(second)}."
                )
        missing = self.missing
        if missing and not allow_gaps:
            which = number_ranges(missing, self.step)
            raise FileError(
                f"lacks {_count(missing, self)} of {printable(self.name)[:60]}, {which}; copy what is "
                "missing, or have it read as empty slices (--allow-gaps)."
            )
        if len(missing) > len(self.files):
            raise FileError(f"lacks more slices of {printable(self.name)} than it has; number them again.")
        by_number: dict[int, str] = dict(zip(self.numbers, self.files, strict=True))
        return [by_number.get(n) for n in range(self.numbers[0], self.numbers[-1] + 1, self.step)]


def slice_series(names: Iterable[str]) -> tuple[list[SliceSeries], list[str]]:
    """The series of at least three slices among names of files, and the other images.

    The counter is the number that varies; where several do, that with the most values. Minus signs count
    where only some names have them, and hexadecimal digits where all names of a kind do.
    """
    images = sorted((name for name in names if name.lower().endswith(SLICE_SUFFIXES)), key=natural_key)
    ordered = [each for group in _alike(images) for each in group]
    series = [each for each in ordered if MIN_SLICES <= len(each.files) <= MAX_SLICES]
    inside = {file for each in series for file in each.files}
    return sorted(series, key=lambda each: natural_key(each.name)), [
        name for name in images if name not in inside
    ]


def number_ranges(numbers: Iterable[int], step: int = 1) -> str:
    """``number 10``, or ``numbers 3, 7 to 9``; the first few of many."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + step:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    texts = [str(a) if a == b else f"{a} to {b}" for a, b in runs[:6]]
    label = "number" if len(runs) == 1 and runs[0][0] == runs[0][1] else "numbers"
    return f"{label} {', '.join(texts)}{', …' if len(runs) > 6 else ''}"


def _count(missing: tuple[int, ...], series: SliceSeries) -> str:
    many = len(missing) > len(series.files)
    return f"more than {len(series.files):,} slices" if many else plural(len(missing), "slice")


def _alike(images: list[str]) -> Iterable[list[SliceSeries]]:
    """The series in each group of images whose names are the same but for numbers."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for name in images:
        path = Path(name)
        groups.setdefault((*_NUMBER.split(path.stem)[::2], path.suffix.lower()), []).append(name)
    used: set[str] = set()
    for texts, group in sorted(groups.items(), key=lambda item: -len(item[1])):
        if len(texts) < 3 or not used.isdisjoint(group):
            continue
        series = _series_of(group, len(texts) - 2)
        series = [_with_hexadecimal(each, images) for each in series]
        used.update(name for each in series for name in each.files)
        yield series


def _with_hexadecimal(series: SliceSeries, images: list[str]) -> SliceSeries:
    """The series, or that of all images whose names have a hexadecimal number in the place of its counter."""
    before, _, after = series.name.partition("#")
    alike = [name for name in images if name.startswith(before) and name.lower().endswith(after.lower())]
    longer = [name for name in alike if len(name) > len(before) + len(after)]
    return (_hexadecimal(longer) if len(longer) > len(series.files) else None) or series


def _series_of(group: list[str], n_columns: int) -> list[SliceSeries]:
    """The series of names that have numbers in the same places."""
    words = [_NUMBER.split(Path(name).stem)[1::2] for name in group]
    columns = [_values([row[k] for row in words]) for k in range(n_columns)]
    varying = [k for k in range(n_columns) if len(set(columns[k])) > 1] or [n_columns - 1]
    counter = max(varying, key=lambda k: (len(set(columns[k])), _is_even(columns[k]), k))
    others = [k for k in varying if k != counter and len(set(columns[counter])) < len(group)]
    series: dict[tuple[int, ...], list[int]] = {}
    for place in range(len(group)):
        series.setdefault(tuple(columns[k][place] for k in others), []).append(place)
    return [_ordered([group[i] for i in places], [columns[counter][i] for i in places], counter)
            for places in series.values()]  # fmt: skip


def _ordered(names: list[str], numbers: list[int], counter: int) -> SliceSeries:
    order = sorted(range(len(names)), key=lambda i: (numbers[i], natural_key(names[i])))
    parts = _NUMBER.split(Path(names[order[0]]).stem)
    parts[2 * counter + 1] = "#"
    name = "".join(parts) + Path(names[order[0]]).suffix
    return SliceSeries(name, tuple(names[i] for i in order), tuple(numbers[i] for i in order))


def _values(words: list[str]) -> list[int]:
    """Numbers; a sign that all of them have is no sign but separates them from what stands before."""
    if len({word[0] for word in words}) == 1 and words[0][0] in "+-":
        return [int(word[1:]) for word in words]
    return [int(word) for word in words]


def _is_even(values: list[int]) -> bool:
    """Whether numbers, sorted, go up by equal steps."""
    ordered = sorted(set(values))
    return len({b - a for a, b in pairwise(ordered)}) <= 1


def _hexadecimal(names: list[str]) -> SliceSeries | None:
    """The series of names that differ in a hexadecimal number, with letters in some of them."""
    stems = [Path(name).stem for name in names]
    before = _common_length(stems)
    after = _common_length([stem[before:][::-1] for stem in stems])
    middles = [stem[before : len(stem) - after] for stem in stems]
    if len(names) < MIN_SLICES or not all(map(_HEX.fullmatch, middles)):
        return None
    if all(map(str.isdigit, middles)) or not any(map(str.isdigit, middles)):
        return None
    numbers = [int(middle, 16) for middle in middles]
    if len(set(numbers)) < len(names) or len(names) < MIN_HEX_DENSITY * (max(numbers) - min(numbers) + 1):
        return None
    order = sorted(range(len(names)), key=numbers.__getitem__)
    stem = stems[0]
    name = f"{stem[:before]}#{stem[len(stem) - after :] if after else ''}{Path(names[0]).suffix}"
    return SliceSeries(name, tuple(names[i] for i in order), tuple(numbers[i] for i in order))


def _common_length(texts: list[str]) -> int:
    """How many first letters all texts have in common."""
    return sum(1 for _ in takewhile(lambda letters: len(set(letters)) == 1, zip(*texts, strict=False)))


ZARR_METADATA = ("zarr.json", ".zattrs", ".zgroup")
MAX_FILES = 1_000_000
DICOM_SUFFIXES = (".dcm", ".ima", ".dicom")
_PREAMBLE, _DICOM = 128, b"DICM"


def is_zarr(folder: Path) -> bool:
    """Whether a folder is a group or an array of Zarr."""
    return any((folder / name).is_file() for name in ZARR_METADATA)


def zarr_names(folder: Path) -> tuple[str, ...]:
    """All files below a folder of Zarr, relative to it, in the order of their names; links are not followed.

    Raises FileError if there are more than a million.
    """
    folders: list[str] = []
    for place, _, names in os.walk(folder):
        folders += (os.path.relpath(os.path.join(place, name), folder) for name in names)  # noqa: PTH118
        if len(folders) > MAX_FILES:
            raise FileError(f"holds more than {MAX_FILES:,} files; save it with larger chunks.")
    return tuple(sorted(folders))


def is_dicom(path: Path) -> bool:
    """Whether a file begins as DICOM does: 128 bytes and four letters. One that cannot be read does not."""
    try:
        with path.open("rb") as file:
            return file.read(_PREAMBLE + len(_DICOM)).endswith(_DICOM, _PREAMBLE)
    except OSError:
        return False


def dicom_names(folder: Path) -> tuple[str, ...]:
    """The DICOM files in a folder, in the order of their names.

    Where there are some, files with a suffix of DICOM are among them even if they are damaged.
    """
    with os.scandir(folder) as entries:
        likely = [
            entry.name
            for entry in entries
            if not entry.name.startswith(".") and entry.is_file() and _may_be_dicom(entry.name)
        ]
    names = {name for name in likely if is_dicom(folder / name)}
    named = {name for name in likely if name.lower().endswith(DICOM_SUFFIXES)} if names else set()
    return tuple(sorted(names | named))


def _may_be_dicom(name: str) -> bool:
    suffix = Path(name).suffix.lower()
    return suffix in ("", *DICOM_SUFFIXES) or suffix[1:].isdigit()
