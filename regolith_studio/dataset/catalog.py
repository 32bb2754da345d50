"""Find the datasets below a folder, with their exports and simulated angles of repose."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from regolith_studio.dataset.export import FORMAT as EXPORT_FORMAT
from regolith_studio.dataset.export import RECORD
from regolith_studio.dataset.folder_io import DOCUMENT, dataset_hash, read_document
from regolith_studio.dataset.schema import CoarseningRecord, DatasetDocument
from regolith_studio.dataset.serialization import shape_of
from regolith_studio.errors import DatasetError, RegolithError, os_error_reason
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.io.own_files import parse_strict_json
from regolith_studio.messages import N_

RESULT = "repose.json"
"""File with a simulated angle of repose."""
RESULT_FORMAT = "regolith-studio-repose"
DEPTH = 4
"""Levels of folders that are searched."""
MAX_RECORD_BYTES = 20_000_000


@dataclass(frozen=True, eq=False)
class CatalogEntry:
    """One folder of the catalog.

    - ``folder``, ``kind``: path, and whether it holds a ``dataset``, an ``export`` or a ``result``.
    - ``name``: of the dataset, or a description of the export or result.
    - ``sha256``: of the dataset itself, or of the one it was made from; empty if unknown.
    - ``detail``: one line of text.
    - ``facts``: provenance, text by label.
    - ``mesh``: the shape with the largest weight, of volume 1.
    - ``problem``: why the folder cannot be used, in one sentence; otherwise empty.
    """

    folder: Path
    kind: str
    name: str
    sha256: str = ""
    detail: str = ""
    facts: Mapping[str, str] = field(default_factory=dict)
    mesh: Mesh | None = None
    problem: str = ""

    def matches(self, text: str) -> bool:
        """Whether the entry contains every word of a filter."""
        whole = " ".join(
            (self.name, self.kind, self.detail, str(self.folder), self.sha256, *self.facts.values())
        )
        return all(word in whole.casefold() for word in text.casefold().split())


def scan_catalog(root: Path | str) -> Iterator[CatalogEntry]:
    """Datasets, exports and results in and below `root`, sorted by path; hidden folders are skipped.

    Raises DatasetError if `root` is not a folder.
    """
    top = Path(root).resolve()
    if not top.is_dir():
        raise DatasetError(f"{top} is not a folder.")
    for place, folders, files in os.walk(top):
        here = Path(place)
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        if len(here.relative_to(top).parts) >= DEPTH:
            folders.clear()
        for name, read in _READERS.items():
            if name in files:
                folders.clear()
                yield _read(here, name, read)


def provenance_tree(entries: Iterable[CatalogEntry]) -> list[tuple[CatalogEntry, list[CatalogEntry]]]:
    """Each dataset with its exports and results, matched by hash; those without a dataset stand alone."""
    every = list(entries)
    datasets = [entry for entry in every if entry.kind == "dataset"]
    known: dict[str, list[CatalogEntry]] = {}
    tree: list[tuple[CatalogEntry, list[CatalogEntry]]] = []
    for entry in datasets:
        first = entry.sha256 and entry.sha256 not in known
        children = known.setdefault(entry.sha256, []) if first else []
        tree.append((entry, children))
    for entry in every:
        if entry.kind != "dataset":
            if entry.sha256 in known:
                known[entry.sha256].append(entry)
            else:
                tree.append((entry, []))
    return tree


def _read(folder: Path, name: str, read: Any) -> CatalogEntry:
    try:
        entry: CatalogEntry = read(folder)
    except (RegolithError, ValueError, KeyError, TypeError, AttributeError) as error:
        sentence = str(error) if isinstance(error, RegolithError) else f"{name} has an unexpected structure."
        return CatalogEntry(folder, _KINDS[name], folder.name, problem=sentence)
    return entry


def _dataset(folder: Path) -> CatalogEntry:
    document = read_document(folder)
    heaviest = max(document.representatives, key=lambda record: record.weight)
    facets = sorted({record.mesh.n_facets for record in document.representatives})
    span = f"{facets[0]}" if len(facets) == 1 else f"{facets[0]} to {facets[-1]}"
    return CatalogEntry(
        folder=folder,
        kind="dataset",
        name=document.name,
        sha256=dataset_hash(folder),
        detail=f"{len(document.representatives)} shapes of {span} facets, weighted by {document.weighting}",
        facts=_facts(document),
        mesh=shape_of(heaviest).mesh,
    )


def _facts(document: DatasetDocument) -> dict[str, str]:
    """Provenance as text by label, without empty entries."""
    metadata = document.metadata
    sources = sorted({record.source.path for record in document.representatives if record.source})
    coarsening = metadata.coarsening
    facts = {
        "Description": metadata.description,
        "Sources": _few(sources),
        "Steps": " ".join(metadata.processing_steps),
        N_("Model"): metadata.model or "",
        N_("Coarsening"): f"{coarsening.method}, {_resolution(coarsening)}, seed {coarsening.seed}"
        if coarsening
        else "",
        "Software": ", ".join(f"{name} {version}" for name, version in sorted(metadata.software.items())),
    }
    return {label: text for label, text in facts.items() if text}


def _export(folder: Path) -> CatalogEntry:
    record = _record(folder / RECORD, EXPORT_FORMAT)
    lost = "; ".join(str(one) for one in record["loses"])
    return CatalogEntry(
        folder=folder,
        kind="export",
        name=f"{record['dataset']} for {record['exporter']}",
        sha256=str(record.get("dataset_sha256") or ""),
        detail=f"{len(record['files'])} files, {record['software']}",
        facts={"Units": str(record["units"]), "Does not carry": lost},
    )


def _result(folder: Path) -> CatalogEntry:
    record = _record(folder / RESULT, RESULT_FORMAT)
    angle = (record.get("measurement") or {}).get("angle_deg")
    words = "no angle" if angle is None else f"{float(angle):.1f}° angle of repose"
    engine = record["engine"]["label"]
    return CatalogEntry(
        folder=folder,
        kind="result",
        name=f"{words} of {record['dataset']['name']}",
        sha256=str(record["dataset"].get("sha256") or ""),
        detail=f"{engine}, {record['state']}",
    )


def _record(path: Path, format: str) -> dict[str, Any]:
    try:
        if path.exists() and not path.is_file():
            raise DatasetError(f"{path} is not a regular file.")
        if path.stat().st_size > MAX_RECORD_BYTES:
            raise DatasetError(f"{path} is larger than {MAX_RECORD_BYTES // 1_000_000} MB.")
        content = parse_strict_json(path.read_text(encoding="utf-8"), str(path))
    except OSError as error:
        raise DatasetError(f"{path} cannot be read: {os_error_reason(error)}.") from error
    if not isinstance(content, dict) or content.get("format") != format:
        raise DatasetError(f"{path} was not written by Regolith Studio.")
    return content


def _resolution(coarsening: CoarseningRecord) -> str:
    if coarsening.max_error is None:
        return f"{coarsening.n_facets} facets"
    return f"errors below {100 * coarsening.max_error:g} %"


def _few(names: Sequence[str]) -> str:
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return ", ".join(names[:5]) + more


_READERS = {DOCUMENT: _dataset, RECORD: _export, RESULT: _result}
_KINDS = {DOCUMENT: "dataset", RECORD: "export", RESULT: "result"}
