"""Settings of a dataset and of its exports, for options, recipes and forms."""

from dataclasses import dataclass
from typing import Literal

from regolith_studio.messages import N_
from regolith_studio.settings import check_settings, setting


@dataclass(frozen=True)
class RepresentativesSettings:
    """How the particles of a dataset are chosen."""

    count: int = setting(
        10,
        N_("Number of representatives"),
        "Number of representative particles; 0 keeps all particles.",
        minimum=0,
        maximum=100_000,
        option="--representatives",
    )
    weighting: Literal["number", "volume"] = setting(
        "number",
        N_("Weighting of the representatives"),
        "Weighting of the representatives.",
        choices={
            "number": N_("Each particle counts equally"),
            "volume": N_("Particles count by their volume"),
        },
        metavar="W",
    )
    size_importance: float = setting(
        0.0,
        "Weight of the size",
        "Weight of a standard deviation of ln d, relative to one of a shape feature, in the choice of "
        "representatives.",
        minimum=0.0,
        maximum=1e6,
        metavar="X",
    )

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class DatasetSettings(RepresentativesSettings):
    """Which particles a dataset holds, their sizes, and its name."""

    sizes: str = setting(
        "measured",
        N_("Kind of size distribution"),
        "Size distribution: measured, classes:25,37,..., fitted:log-normal, log-normal:50,0.4, ...",
        metavar="SPEC",
    )
    name: str = setting(
        "", N_("Name of the dataset"), "Name of the dataset; that of the folder if omitted.", metavar="NAME"
    )


@dataclass(frozen=True)
class ExportSettings:
    """Settings that all exporters share."""

    coarse_graining_factor: float = setting(
        1.0,
        N_("Coarse-graining factor"),
        "Factor on all diameters (section 2.6); 1 keeps the particles' sizes, the paper takes 10.",
        minimum=1e-6,
        maximum=1e6,
        option="--coarse-graining",
        metavar="F",
    )
    n_particles: int = setting(
        200,
        N_("Particles drawn"),
        "Number of particles in formats that list single ones.",
        minimum=1,
        maximum=1_000_000,
        option="--particles",
    )
    max_error: float = setting(
        0.0,
        "Error of spheres",
        "Largest mismatch (Jaccard distance) of shapes made of spheres; takes as many as needed.",
        minimum=0.0,
        maximum=0.9,
        metavar="E",
    )

    def __post_init__(self) -> None:
        check_settings(self)
