"""Jobs that write the labels of grains for other programs."""

from pathlib import Path

from regolith_studio.imaging.extraction import ExtractionSettings, LabelSelection, select_labels
from regolith_studio.imaging.label_files import write_label_file
from regolith_studio.imaging.volume import Volume
from regolith_studio.io.atomic import write_bytes
from regolith_studio.io.tables import Column, Table, csv_text
from regolith_studio.jobs.events import Progress, Started, Steps
from regolith_studio.messages import N_, Message


def write_labels(labels: Volume, settings: ExtractionSettings, path: Path, segmented: bool) -> Steps:
    """Write a label volume, and the table of its labels beside it; returns the path of the table.

    Parameters
    ----------
    settings, segmented
        Which labels become particles, as for ``select_labels``.
    path
        A name that ends in one of ``LABEL_SUFFIXES``; the table has the same name with ``.csv``.

    Raises
    ------
    InputError
        If there is no label, or the suffix is another.
    FileError
        If the file cannot be written.
    """
    yield Started(Message(N_("Writing labels to {name}"), name=path.name))
    chosen = select_labels(labels, settings, segmented)
    for done, total in write_label_file(path, labels, max(chosen.boxes)):
        yield Progress(done, total)
    table = label_names_file(path)
    write_bytes(table, csv_text(label_names(chosen)).encode("utf-8"))
    return table


def label_names_file(path: Path) -> Path:
    """The table that is written beside a file of labels."""
    return path.with_suffix(".csv")


def label_names(chosen: LabelSelection) -> Table:
    """The particle of each label, or why it became none, and its number of voxels."""
    left_out = dict.fromkeys(chosen.border, "border") | dict.fromkeys(chosen.small, "small")
    columns = (Column("label"), Column("particle"), Column("left_out"), Column("voxels"))
    rows = tuple(
        (label, None if label in left_out else chosen.name_of(label), left_out.get(label), count)
        for label, count in sorted(chosen.sizes.items())
    )
    return Table(N_("Particles of labels"), columns, rows)
