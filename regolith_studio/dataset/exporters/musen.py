"""MUSEN: a database of multispheres, in the protocol-buffer format of its agglomerates."""

import struct
from collections.abc import Iterable

import numpy as np

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.export import NOTES, Exporter, ExportOptions, shape_names, sizes_csv
from regolith_studio.dataset.multisphere import fit_spheres_by, sphere_fit_errors
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.messages import N_

_NOTE = """shapes.madb: open it as the database of agglomerates and multispheres. Each shape is one, of
the median size of its class in metres (coarse graining applied); other sizes, of sizes.csv, by the scaling
factor of the package generator. Its spheres name a compound of the shape's own.
MUSEN adds up overlapping spheres as if none overlapped: give each compound the density below, with which a
particle has the polyhedron's mass. The volume stated in the file is the polyhedron's. Read back by Google's
protocol buffers with the message types that MUSEN publishes; MUSEN itself was not run.
{rows}"""

MULTISPHERE = 1
"""Type of an agglomerate without bonds."""


def _files(dataset: Dataset, options: ExportOptions) -> dict[str, bytes]:
    shapes, fits = b"", []
    for key, one in zip(shape_names(dataset), dataset.representatives, strict=True):
        spheres = fit_spheres_by(one.shape, options.n_spheres, options.max_error)
        scale = float(one.sizes.quantile(0.5)) * options.to_metres
        shapes += _message(1, _multisphere(key, spheres * scale, one.shape.volume * scale**3))
        summed = float(4 / 3 * np.pi * (spheres[:, 3] ** 3).sum() / one.shape.volume)
        fits.append(
            f"  {key}: {len(spheres)} spheres, Jaccard distance "
            f"{sphere_fit_errors(one.shape, spheres).jaccard:.3f}, density of its compound "
            f"{options.contact.density / summed!r} kg/m3"
        )
    return {
        "shapes.madb": shapes,
        "sizes.csv": sizes_csv(dataset),
        NOTES: _NOTE.format(rows="\n".join(fits)).encode("utf-8"),
    }


def _multisphere(key: str, spheres: FloatArray, volume: float) -> bytes:
    """The message of one multisphere: name, key, volume, particles, type."""
    particles = (_particle(key, *row) for row in spheres.tolist())
    return b"".join(
        [
            _text(1, key),
            _text(2, key),
            _doubles([(3, volume)]),
            *(_message(4, each) for each in particles),
            bytes([6 << 3, MULTISPHERE]),
        ]
    )


def _particle(compound: str, x: float, y: float, z: float, radius: float) -> bytes:
    """The message of a sphere: place, radius, compound, quaternion, contact radius."""
    return b"".join(
        [
            _message(1, _doubles(enumerate((x, y, z), start=1))),
            _doubles([(2, radius)]),
            _text(3, compound),
            _message(5, _doubles(enumerate((1.0, 0.0, 0.0, 0.0), start=1))),
            _doubles([(6, radius)]),
        ]
    )


def _doubles(fields: Iterable[tuple[int, float]]) -> bytes:
    """Fields of 8 bytes of a protocol buffer: number and wire type 1, then the value."""
    return b"".join(struct.pack("<Bd", number << 3 | 1, value) for number, value in fields)


def _message(number: int, content: bytes) -> bytes:
    """A field with a length: number and wire type 2, the length in groups of 7 bits, the content."""
    length, rest = bytearray(), len(content)
    while rest > 0x7F:
        length.append(rest & 0x7F | 0x80)
        rest >>= 7
    return bytes([number << 3 | 2, *length, rest]) + content


def _text(number: int, text: str) -> bytes:
    return _message(number, text.encode("utf-8"))


EXPORTER = Exporter(
    key="musen",
    label="MUSEN (multispheres)",
    units=N_("metres, coarse graining applied; each shape at the median size of its class"),
    carries=(N_("shapes approximately"), N_("volume")),
    loses=(
        N_("flat facets and edges"),
        N_("mass, unless each compound gets the density that the README states"),
        N_("moments of inertia are sums over the spheres"),
        N_("weights and size distributions (sizes.csv has them)"),
        N_("contact parameters"),
    ),
    load_command="open {folder}/shapes.madb as database of agglomerates",
    files=_files,
    convex_only="",
    alters=N_("overlapping spheres stand for each polyhedron; facets become bumpy, corners round."),
)
