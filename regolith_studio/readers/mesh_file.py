"""One untrusted file of bytes to checked triangles; runs in the guarded child process only."""

import codecs
from dataclasses import replace
from pathlib import Path

import numpy as np

from regolith_studio.errors import FileError
from regolith_studio.readers.formats import mesh_formats, mesh_suffixes
from regolith_studio.readers.mesh_format import MeshFormat, ParsedMesh
from regolith_studio.readers.sentences import printable, sentence_about
from regolith_studio.readers.volume_formats import volume_formats, volume_suffixes

LARGEST_COORDINATE = 1e40
"""Beyond it the sixth powers in the checks would leave the range of float64."""


def parse_mesh(data: bytes, path: Path) -> tuple[ParsedMesh, MeshFormat]:
    """Triangles with finite corners and valid indices, and the format that they came in.

    The content decides where it is unmistakable, the suffix otherwise.

    Raises
    ------
    FileError
        With a whole sentence that names the file.
    """
    try:
        data = _as_bytes_of_one(data)
        row, notes = _format_of(data, path)
        with np.errstate(all="ignore"):
            parsed = row.parse(data, path)
            return _checked(replace(parsed, notes=notes + parsed.notes)), row
    except FileError as error:
        raise FileError(sentence_about(path, str(error))) from None


def _as_bytes_of_one(data: bytes) -> bytes:
    """Text without the byte order mark that some editors put first, and never in UTF-16."""
    if data.startswith(codecs.BOM_UTF8):
        return data[len(codecs.BOM_UTF8) :]
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", "replace").encode()
    return data


def _format_of(data: bytes, path: Path) -> tuple[MeshFormat, tuple[str, ...]]:
    if not data:
        raise FileError("is empty: it has no bytes at all.")
    suffix = path.suffix.lower()
    suffix_or_none = printable(path.suffix) or "without a suffix"
    named = next((row for row in mesh_formats().values() if suffix in row.suffixes), None)
    shown = next((row for row in mesh_formats().values() if row.recognises(data[:1024])), None)
    if shown is not None and shown is not named:
        return shown, (f"The file is named {suffix_or_none} but holds {shown.label}.",)
    if named is not None:
        return named, ()
    if path.name.lower().endswith(tuple(volume_suffixes() - set(volume_formats()["raw"].suffixes))):
        raise FileError(
            "is a volume of voxels, not a mesh: make particles of it with “regolith-studio extract”, or on "
            "the page Scan of the window."
        )
    raise FileError(
        f"is of no kind that is read here ({suffix or 'no suffix'}); "
        f"what is read are meshes in {', '.join(sorted(mesh_suffixes()))}."
    )


def _checked(parsed: ParsedMesh) -> ParsedMesh:
    vertices, faces = parsed.vertices, parsed.faces
    if not len(vertices):
        raise FileError("holds an empty mesh: it has no vertices.")
    if not len(faces):
        raise FileError(
            f"is a point cloud: its number of points is {len(vertices):,}, and it has no faces; "
            "reconstruct a surface first."
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise FileError(f"has faces that point to vertices beyond its {len(vertices):,}.")
    good = np.asarray((np.abs(vertices) < LARGEST_COORDINATE).all(axis=1))
    if good.all():
        return parsed
    kept = np.asarray(good[faces].all(axis=1))
    if not kept.any():
        raise FileError("has no face whose corners are all finite numbers; export it again.")
    lost = len(faces) - np.count_nonzero(kept)
    notes = parsed.notes
    if lost:
        notes += (f"Left out {lost:,} faces with a corner that is not a finite number.",)
    return ParsedMesh(np.where(good[:, None], vertices, 0.0), faces[kept], notes)
