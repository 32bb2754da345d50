"""Writes a dataset in the formats of DEM programs, one folder a format."""

from collections.abc import Sequence
from pathlib import Path

from regolith_studio.dataset.exporters import EXPORTERS
from regolith_studio.dataset.exporting import Exported, Exporter, ExportOptions, check_consent, write_export
from regolith_studio.dataset.folder import read_dataset
from regolith_studio.dataset.reading import dataset_hash
from regolith_studio.errors import InputError
from regolith_studio.jobs.events import Partial, Progress, Started, Steps


def export_dataset_folder(
    source: Path, keys: Sequence[str], target: Path, options: ExportOptions, accept_loss: bool = False
) -> Steps:
    """Export the dataset in `source` to ``target/<key>`` for each key; returns the exports.

    Between two formats the work can be stopped; each format's folder is written as a whole.

    Raises
    ------
    InputError
        If there is no such format.
    DatasetError
        If a format changes shapes and that was not accepted (before anything is written), the dataset
        is broken, or something cannot be written.
    """
    exporters = chosen_exporters(keys)
    yield Started("Exporting", len(exporters))
    for exporter in exporters:
        check_consent(exporter, accept_loss)
    dataset, digest = read_dataset(source), dataset_hash(source)
    done: list[Exported] = []
    for number, exporter in enumerate(exporters):
        yield Progress(number, len(exporters), exporter.label)
        place = target / exporter.key
        done.append(
            write_export(dataset, exporter, place, options, dataset_hash=digest, accept_loss=accept_loss)
        )
        yield Partial(done[-1])
    yield Progress(len(exporters), len(exporters), str(target))
    return tuple(done)


def chosen_exporters(keys: Sequence[str]) -> tuple[Exporter, ...]:
    """The formats of these keys, each once; all of them for ``all``.

    Raises
    ------
    InputError
        If there is no such format.
    """
    wanted = list(EXPORTERS) if "all" in keys else list(dict.fromkeys(keys))
    for key in wanted:
        if key not in EXPORTERS:
            raise InputError(f"There is no format {key!r}; there are {', '.join(sorted(EXPORTERS))}.")
    if not wanted:
        raise InputError("No format was chosen.")
    return tuple(EXPORTERS[key] for key in wanted)
