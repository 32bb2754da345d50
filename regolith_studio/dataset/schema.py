"""The fields of ``dataset.json``; the published JSON Schema is generated from them.

Run ``python -m regolith_studio.dataset.schema FILE`` to update ``resources/schema/dataset.schema.json``.
"""

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from regolith_studio.dataset.size_distributions import WEIGHT_TOLERANCE, AnySizes, Weighting

FORMAT = "regolith-studio-dataset"
SCHEMA_VERSION = 4
MESH_PATH = r"""^meshes/[^./\\:*?"<>|\x00-\x1f\x7f][^/\\:*?"<>|\x00-\x1f\x7f]*\.stl$"""
"""Of a file directly in that folder, and not hidden; no signs that separate folders, drives or streams."""

Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 of the file's bytes.")]
Triple = tuple[float, float, float]
Scalar = bool | int | float | str | None


class SchemaModel(BaseModel):
    """Base of all records: immutable, without unknown fields, infinities and implicit conversions."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class MeshRecord(SchemaModel):
    """The STL file of a shape or of a part: closed, outward normals, float32.

    Of one convex polyhedron the triangles are those of its facets. Of a compound they are the surface of the
    union, without what lies inside other parts, and n_facets counts the facets of all parts.
    """

    file: Annotated[
        str, Field(pattern=MESH_PATH, description="Relative to dataset.json, with forward slashes.")
    ]
    sha256: Sha256
    n_facets: Annotated[int, Field(ge=4, description="Polygonal facets, which is what n facets means.")]
    n_vertices: Annotated[int, Field(ge=4)]
    n_triangles: Annotated[int, Field(ge=4)]


class HalfSpacesRecord(SchemaModel):
    """A convex polyhedron exactly: all x with <normal_i, x> <= offset_i, dimensionless."""

    normals: tuple[Triple, ...] = Field(min_length=4, description="Outward unit normals.")
    offsets: tuple[Annotated[float, Field(gt=0.0)], ...] = Field(min_length=4)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if len(self.normals) != len(self.offsets):
            raise ValueError(f"{len(self.normals)} normals need as many offsets, got {len(self.offsets)}")
        return self


class PartRecord(SchemaModel):
    """A convex part of a compound: all x with <normal_i, x - origin> <= offset_i."""

    origin: Triple = Field(description="Of the half-spaces, in the frame of the shape.")
    half_spaces: HalfSpacesRecord
    mesh: MeshRecord = Field(description="Of the part alone, in the frame of the shape.")


class CompoundRecord(SchemaModel):
    """A shape that is the union of convex parts, which overlap or touch; all numbers are of the union.

    What parts share counts once, so that these are not the sums over the parts.
    """

    parts: tuple[PartRecord, ...] = Field(min_length=1)
    volume: float = Field(description="Also the mass at density 1.")
    centre_of_mass: Triple
    inertia: tuple[Triple, Triple, Triple] = Field(
        description="Tensor of inertia about the centre of mass at density 1, row by row."
    )
    descriptors: dict[str, float] = Field(
        description="At unit volume, by the keys of the catalogue; convexity is V / CH."
    )


class FrameRecord(SchemaModel):
    """Pose of the shape in its particle: x_shape = rotation (x_particle - centroid) / scale."""

    rotation: tuple[Triple, Triple, Triple] = Field(description="Row by row.")
    centroid_um: Triple
    scale_um: Annotated[float, Field(gt=0.0, description="Cube root of the polyhedron's volume.")]


class Approximation(SchemaModel):
    """How the shape approximates its particle."""

    # A loss or an error may be infinite until the dataset is written, which then refuses it by name.
    model_config = ConfigDict(allow_inf_nan=True)

    method: str
    n_facets_asked: int = Field(description="Requested number of facets.")
    errors: dict[str, float] = Field(description="Relative error of each descriptor (Eq. 8).")
    jaccard_distance: float = Field(description="Eq. 7; 0 same, 1 disjoint.")
    loss: float = Field(description="Eq. 9.")
    reason: str | None = Field(description="Why a request was not met.")


class SourceRecord(SchemaModel):
    """A measured file, under the path given by the user."""

    path: str
    sha256: str
    unit: str = Field(description="Length unit of the file's numbers.")


class RepresentativeRecord(SchemaModel):
    """One class: a unit-volume shape, its weight alpha_i and its size distribution F_i."""

    name: Annotated[str, Field(min_length=1)]
    group: str
    weight: Annotated[float, Field(ge=0.0, le=1.0)]
    n_members: Annotated[int, Field(ge=1, description="Particles that the class stands for.")]
    sizes: AnySizes
    mesh: MeshRecord
    half_spaces: HalfSpacesRecord | None = Field(description="Of one convex polyhedron of unit volume.")
    compound: CompoundRecord | None = Field(description="Of a shape of several convex parts.")
    frame: FrameRecord
    approximation: Approximation | None
    source: SourceRecord | None

    @model_validator(mode="after")
    def _is_one_shape(self) -> Self:
        if (self.half_spaces is None) == (self.compound is None):
            raise ValueError("a shape has either half_spaces or compound")
        return self

    @property
    def mesh_records(self) -> tuple[MeshRecord, ...]:
        """Of the shape, then of each part of a compound."""
        parts = self.compound.parts if self.compound else ()
        return (self.mesh, *(part.mesh for part in parts))


class CoarseningRecord(SchemaModel):
    """Settings of the coarsening of all shapes."""

    method: str
    n_facets: int = Field(description="The upper limit if max_error is given.")
    seed: int
    target: str = Field(description="particle or fit: which surface was approximated.")
    preset: str | None
    weights: dict[str, float] = Field(description="Loss weights of Eq. 9.")
    settings: dict[str, Scalar]
    max_error: float | None = Field(
        default=None,
        description="If given, each shape has the minimum number of facets with all weighted errors below.",
    )


class Representation(SchemaModel):
    """How well the dataset reproduces the population that its representatives were chosen from."""

    n_particles: Annotated[int, Field(ge=1, description="Of the population.")]
    errors: dict[str, float] = Field(
        description="Of the shapes in the dataset: Wasserstein distance per descriptor, in standard "
        "deviations of the population."
    )
    source_errors: dict[str, float] = Field(
        description="The same of the particles that the shapes were made from."
    )
    sampling_noise: dict[str, float] = Field(
        description="The same between the population and its material: the resolution of the sample."
    )
    population: dict[str, tuple[float, ...]] = Field(
        description="Quantiles of each descriptor of the population at even shares, counted as the weights."
    )
    deviations: dict[str, float] = Field(
        description="Standard deviation of each descriptor of the population."
    )


class MetadataRecord(SchemaModel):
    """Origin of the dataset."""

    description: str
    processing_steps: tuple[str, ...]
    seed: int | None
    model: str | None = Field(description="Stochastic model of the shapes; null for measured ones.")
    l_max: Annotated[int, Field(ge=0)] | None
    angular_power_spectrum_um2: tuple[Annotated[float, Field(ge=0.0)], ...] | None = Field(
        description="A_l, l = 0..l_max, variance per order (real orthonormal, no Condon-Shortley phase)."
    )
    coarsening: CoarseningRecord | None
    representation: Representation | None = Field(
        description="Null if every particle represents only itself."
    )
    software: dict[str, str] = Field(description="Versions by package.")


class DatasetDocument(SchemaModel):
    """A dataset of representative particles (section 2.5)."""

    format: Literal["regolith-studio-dataset"]
    schema_version: Literal[4]
    name: str
    length_unit: Literal["um"] = Field(description="Of all lengths whose key ends in _um.")
    shape_unit: Literal["unit volume"] = Field(description="Shapes have volume 1 and no length unit.")
    size_measure: Literal["equivalent diameter"] = Field(
        description="Diameter of the ball of the same volume."
    )
    vertical_axis: Literal["z"]
    weighting: Weighting = Field(
        description="Whether weights count particles, or their volume (mass, at one density)."
    )
    representatives: tuple[RepresentativeRecord, ...] = Field(min_length=1)
    metadata: MetadataRecord

    @model_validator(mode="after")
    def _fits(self) -> Self:
        total = sum(record.weight for record in self.representatives)
        if abs(total - 1.0) > WEIGHT_TOLERANCE:
            raise ValueError(f"weights must add up to 1 within {WEIGHT_TOLERANCE}, they add up to {total!r}")
        for key, values in (
            ("names", [record.name for record in self.representatives]),
            (
                "mesh files",
                [mesh.file.casefold() for record in self.representatives for mesh in record.mesh_records],
            ),
        ):
            if len(set(values)) != len(values):
                raise ValueError(f"{key} of representatives must differ")
        return self


def json_schema() -> dict[str, Any]:
    """The published schema, JSON Schema 2020-12."""
    schema = DatasetDocument.model_json_schema()
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"{FORMAT}-{SCHEMA_VERSION}",
        **schema,
    }


def schema_text() -> str:
    """The published schema as the file has it."""
    return json.dumps(json_schema(), indent=2, sort_keys=True) + "\n"


def main(arguments: Sequence[str]) -> int:
    """Write the schema to the file named on the command line."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m regolith_studio.dataset.schema FILE\n")
        return 2
    Path(arguments[0]).write_text(schema_text(), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
