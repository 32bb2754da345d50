"""``dataset build`` and ``validate``."""

from pathlib import Path


def test_that_a_damaged_dataset_is_found_out(command, grains: Path, tmp_path: Path) -> None:
    command("dataset", "build", grains, "-o", tmp_path / "set", "--method", "quadric")
    mesh = next((tmp_path / "set").rglob("*.stl"))
    mesh.write_bytes(mesh.read_bytes()[:-1])
    result = command("dataset", "validate", tmp_path / "set", "--json")
    assert result.code == 1
    assert result.json["valid"] is False
    assert any(mesh.name in problem for problem in result.json["problems"])


def test_that_other_peoples_files_are_never_replaced(command, grains: Path, tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("important")
    for overwrite in ([], ["--overwrite"]):
        result = command("dataset", "build", grains, "-o", tmp_path, "--method", "quadric", *overwrite)
        assert result.code == 1
        assert len(result.err.strip().splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]


def test_that_a_dataset_of_the_same_place_is_replaced_only_if_allowed(
    command, grains: Path, tmp_path: Path
) -> None:
    build = ("dataset", "build", grains / "grain-a.stl", "-o", tmp_path / "set", "--method", "quadric")
    assert command(*build).code == 0
    assert command(*build).code == 1
    assert command(*build, "--overwrite").code == 0
