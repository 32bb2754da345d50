"""The fingerprint by which a project knows the scan that its corrections belong to."""

from pathlib import Path

from regolith_studio.session.project import FINGERPRINTED, fingerprint


def test_that_a_file_that_has_changed_or_is_gone_has_another_fingerprint(tmp_path: Path) -> None:
    scan = tmp_path / "scan.raw"
    scan.write_bytes(bytes(3 * FINGERPRINTED))
    known = fingerprint(scan)
    assert known == fingerprint(scan) != ""
    scan.write_bytes(bytes(3 * FINGERPRINTED - 1) + b"x")
    assert fingerprint(scan) != known
    assert fingerprint(tmp_path / "none.raw") == ""


def test_that_a_folder_of_slices_is_known_by_names_and_sizes(tmp_path: Path) -> None:
    (tmp_path / "0.tif").write_bytes(b"abc")
    known = fingerprint(tmp_path)
    (tmp_path / "1.tif").write_bytes(b"abc")
    assert fingerprint(tmp_path) != known
