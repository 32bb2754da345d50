"""Real scans and the bad files of other programs: all come in, or are refused in one sentence."""

import pytest

from regolith_studio.errors import RegolithError
from regolith_studio.readers.formats import mesh_suffixes
from regolith_studio.readers.particles import read_mesh, read_particles

pytestmark = pytest.mark.real_data


def meshes_below(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix.lower() in mesh_suffixes())


@pytest.mark.parametrize(
    ("folder", "count", "unit"),
    [
        ("cement140/voxel", 40, "voxel:1"),
        ("cement140/smooth", 75, "um"),
        ("apollo", 11, "m"),
        ("bad/winding", 39, "mm"),
    ],
)
@pytest.mark.slow
def test_that_every_real_scan_comes_in_facing_outwards(folder, count, unit, real_data):
    problems = []
    particles = read_particles(
        [real_data(folder)], unit, on_problem=lambda *problem: problems.append(problem)
    )
    assert problems == []
    assert len(particles) == count
    assert all(particle.mesh.volume > 0.0 for particle in particles)


def test_that_the_inside_out_stones_are_turned_and_told_so(real_data):
    for path in meshes_below(real_data("bad/winding")):
        assert any(note.startswith("Reoriented") for note in read_mesh(path).notes), path.name


def test_that_an_apollo_rock_with_double_faces_keeps_its_volume(real_data):
    """28 loose double triangles and one body: the report names both, the volume is untouched."""
    path = real_data("apollo") / "apollo_sample15.ply"
    raw, mended = read_mesh(path, unit="m", repair=False), read_mesh(path, unit="m")
    assert "Removed 56 double faces." in mended.notes
    assert mended.mesh.volume == pytest.approx(raw.mesh.volume, rel=1e-9)


@pytest.mark.parametrize("folder", [pytest.param("bad/trimesh", marks=pytest.mark.slow), "bad/assimp"])
def test_that_bad_corpora_give_values_or_one_sentence_without_a_hang(folder, real_data):
    read, sentences = 0, []
    paths = meshes_below(real_data(folder))
    assert len(paths) > 40
    for path in paths:
        try:
            particle = read_mesh(path)
        except RegolithError as error:
            sentences.append((path.name, str(error)))
        else:
            assert particle.mesh.volume > 0.0
            read += 1
    assert read > 20
    assert not [text for _, text in sentences if "given up" in text or "crashed the process" in text]
    assert all(text.startswith(name) and text.endswith(".") and "\n" not in text for name, text in sentences)
