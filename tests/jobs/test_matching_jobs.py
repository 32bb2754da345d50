"""Jobs that compare a sample with other materials."""

import zipfile

import pytest

from regolith_studio.errors import InputError
from regolith_studio.geometry.particle import Particle
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.jobs.events import Started
from regolith_studio.jobs.matching_jobs import match_materials


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("other.csv", "no column of length, width and thickness; its columns are foo, bar"),
        ("text.zip", "holds no mesh"),
        ("nowhere.zip", "nowhere.zip"),
        ("few.zip", "few/fine has 19 particles; a comparison needs at least 20"),
    ],
)
def test_that_a_candidate_that_cannot_be_read_is_refused_before_anything_is_measured(tmp_path, name, reason):
    (tmp_path / "other.csv").write_text("foo,bar\n1,2\n")
    with zipfile.ZipFile(tmp_path / "text.zip", "w") as archive:
        archive.writestr("notes.txt", "none")
    with zipfile.ZipFile(tmp_path / "few.zip", "w") as archive:
        for k in range(39):
            archive.writestr(f"few/{'coarse' if k < 20 else 'fine'}/{k}.stl", b"")
    sample = tuple(Particle(f"ball-{k}", icosphere(2).moved(scale=10.0 + k)) for k in range(3))
    steps: list[object] = []
    with pytest.raises(InputError, match=reason):
        steps.extend(match_materials(sample, ["luna", str(tmp_path / name)]))
    assert "Measuring" not in [step.title for step in steps if isinstance(step, Started)]
