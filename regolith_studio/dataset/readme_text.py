"""The README.txt of a dataset folder, for whoever finds it without the program."""

from regolith_studio.dataset.dataset import Dataset
from regolith_studio.dataset.schema import SCHEMA_VERSION

README = """\
{name}

A dataset of {count} representative particle shapes for the discrete element method,
written by Regolith Studio.

dataset.json   weights, size distributions, exact half-spaces, where everything comes from.
               Its fields are described by the JSON Schema of the program
               (resources/schema/dataset.schema.json), schema version {version}.
meshes/        one binary STL a shape: closed, convex, outward normals, volume 1, centroid at
               the origin, longest principal axis along x, shortest along z. STL has no unit;
               these have none either.

To make a particle: choose a class by the weights (they count {counted}), draw an equivalent
diameter d (in micrometres) from the sizes of the class, and scale the shape by
d * (pi / 6)^(1/3) = 0.80600 d, so that its volume is that of a ball of diameter d. Then turn it at
random. If a program asks for a size of its own, choose the equivalent (volume) diameter.

"n_facets" counts polygonal facets; the STL cuts them into triangles. The half-spaces in
dataset.json are the exact shape: all x with <normal_i, x> <= offset_i.
To go back to the place of a shape in its particle: x_particle = scale rotation^T x_shape + centroid.

To check the folder:   regolith-studio dataset validate .
In Python:             import regolith_studio; regolith_studio.read_dataset(".")
""".replace("{version}", str(SCHEMA_VERSION))


def readme_text(dataset: Dataset) -> str:
    """The README of a dataset."""
    counted = "particles" if dataset.weighting == "number" else "volume, not particles"
    return README.format(name=dataset.name, count=len(dataset), counted=counted)
