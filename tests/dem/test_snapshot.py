"""Files of particles at one moment."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from regolith_studio.dem.run_io import FORMAT, read_final_state, save_result
from regolith_studio.dem.snapshot import ParticleState, particle_state_bytes, read_particle_state
from regolith_studio.errors import FileError


def _pile() -> ParticleState:
    generator = np.random.default_rng(0)
    return ParticleState(
        generator.normal(size=(5, 3)),
        generator.uniform(1e-3, 2e-3, 5),
        np.tile([1.0, 0, 0, 0], (5, 1)),
        np.arange(5),
        1.5,
        0.02,
        "lift",
    )


def test_that_a_pile_comes_back_from_its_file(tmp_path: Path) -> None:
    pile = _pile()
    (tmp_path / "p.npz").write_bytes(particle_state_bytes(pile))
    back = read_particle_state(tmp_path / "p.npz")
    assert back.points == pytest.approx(pile.points, rel=1e-6)
    assert np.array_equal(back.diameters, pile.diameters)
    assert (back.time, back.wall, back.phase) == (1.5, 0.02, "lift")
    assert np.array_equal(back.class_index, pile.class_index)


def test_that_another_file_is_refused_in_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "p.npz"
    with pytest.raises(FileError, match="cannot be read"):
        read_particle_state(path)
    path.write_bytes(b"nothing of ours")
    with pytest.raises(FileError, match="no particles"):
        read_particle_state(path)
    path.write_bytes(particle_state_bytes(_pile())[:200])
    with pytest.raises(FileError, match="no particles"):
        read_particle_state(path)
    np.savez(path, other=np.zeros(3))
    with pytest.raises(FileError, match="no particles"):
        read_particle_state(path)
    np.savez(path, points_m=np.array([object()]))
    with pytest.raises(FileError, match="no particles"):
        read_particle_state(path)


def test_that_the_final_state_of_another_run_is_refused(tmp_path: Path) -> None:
    save_result(tmp_path, {"format": FORMAT}, _pile(), 1.0)
    assert len(read_final_state(tmp_path / "final.npz")) == 5
    other = replace(_pile(), time=2.5)
    (tmp_path / "final.npz").write_bytes(particle_state_bytes(other))
    with pytest.raises(FileError, match="not the final state of the run"):
        read_final_state(tmp_path / "final.npz")
