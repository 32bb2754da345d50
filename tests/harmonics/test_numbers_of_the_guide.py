"""Sentences and a table of the page on harmonics against fits of the shipped particles."""

from pathlib import Path

import pytest

from regolith_studio.descriptors.describe import describe
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.harmonics.synthesis import reconstruct
from regolith_studio.readers.particles import sample_particles

PAGE = " ".join((Path(__file__).parents[2] / "docs/harmonics.md").read_text("utf-8").split())
MESHES: dict[str, Mesh] = {each.name: each.mesh for each in sample_particles()}


def test_that_the_table_of_reference_surfaces_has_the_errors_of_fits() -> None:
    rows = PAGE.partition("| l_max = 10 | sphere | ellipsoid | | --- | --- | --- |")[2].partition("## ")[0]
    lines = [line.split(" | ") for line in rows.strip(" |").split(" | | ")]
    assert sum(len(names.split(", ")) for names, _, _ in lines) == 9
    for names, *columns in lines:
        for reference, said in zip(("sphere", "ellipsoid"), columns, strict=True):
            fits = [fit_harmonics(MESHES[name], 10, reference=reference) for name in names.split(", ")]
            found = [100 * fit.radial_error for fit in fits]
            assert [float(cell.strip("% |")) for cell in said.split(", ")] == pytest.approx(found, abs=0.06)


def test_that_the_sentence_on_hidden_surfaces_has_the_shares_of_fits() -> None:
    fits = {name: fit_harmonics(mesh, 10) for name, mesh in MESHES.items()}
    lobed = [fits[f"agglutinate-{number}"] for number in (1, 2)]
    surface = "{:.0f} and {:.0f}".format(*(100 * fit.hidden_surface_share for fit in lobed))
    volume = "{:.1f} and {:.1f}".format(*(100 * fit.unrepresentable_volume_share for fit in lobed))
    assert f"{surface} % of the surface are hidden, and {volume} % of the volume are displaced" in PAGE
    hidden = {name for name, fit in fits.items() if fit.hidden_surface_share > 0.0}
    assert hidden == {"agglutinate-1", "agglutinate-2"}


@pytest.mark.slow
def test_that_the_sentence_on_the_smallest_diameter_has_the_errors_of_fits() -> None:
    mesh = MESHES["agglutinate-1"]
    true, fit = describe(mesh, ("min_diameter",))["min_diameter"], fit_harmonics(mesh, 30)
    cuts = [describe(reconstruct(fit, n, level=5), ("min_diameter",))["min_diameter"] for n in (15, 16, 30)]
    at_15, at_16, at_30 = (100 * (found / true - 1) for found in cuts)
    assert f"from {at_15:.1f} % at l_max = 15 to {at_16:+.1f} % at 16 and {at_30:+.1f} % at 30" in PAGE
