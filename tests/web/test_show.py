"""``rs.show`` in a notebook."""

import sys
import time
import urllib.error
import urllib.request

import pytest

import regolith_studio as rs
from regolith_studio.errors import InputError, MissingRequirement


def test_that_show_without_trame_says_which_extra_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "trame.widgets.vtk", None)
    with pytest.raises(MissingRequirement, match=r"regolith-studio\[notebook\]"):
        rs.show(rs.sample_particles()[0])


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [({"l_max": 31}, "30"), ({"n_facets": 4}, "5"), ({"method": "best"}, "best")],
)
def test_that_values_out_of_range_are_refused_before_anything_is_served(
    arguments: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        rs.show(rs.sample_particles()[0], **arguments)


def test_that_no_particle_is_refused() -> None:
    with pytest.raises(InputError, match="no particle to show"):
        rs.show([])


@pytest.mark.slow
def test_that_two_notebook_views_live_side_by_side_and_end_when_closed() -> None:
    pytest.importorskip("trame_vtk", reason="The views in a notebook need trame, an extra.")
    particles = rs.sample_particles()[:2]
    views = [rs.show(particle, l_max=6, n_facets=8) for particle in particles]
    assert views[0].url != views[1].url
    for view, particle in zip(views, particles, strict=True):
        assert f'src="{view.url}"' in view._repr_html_()
        with urllib.request.urlopen(view.url, timeout=30) as answer:
            assert b"<html" in answer.read()
        deadline = time.monotonic() + 240
        while view.results.coarsened is None and time.monotonic() < deadline:
            time.sleep(0.1)
        fit = rs.reconstruct(rs.fit_harmonics(particle.mesh), 6)
        found = view.results.coarsened
        assert found is not None
        assert found.n_facets == 8
        assert view.results.fit_descriptors["volume"] == pytest.approx(rs.describe(fit)["volume"], rel=1e-6)
        view.close()
        with pytest.raises(urllib.error.URLError):
            urllib.request.urlopen(view.url, timeout=5)
