"""Archives of meshes: what is read of them, and that those made to do harm are refused in one sentence."""

import io
import stat
import zipfile
from pathlib import Path

import pytest

from regolith_studio.errors import FileError
from regolith_studio.readers.particles import (
    FileProblem,
    find_files,
    left_out,
    read_each,
    read_mesh,
    read_particles,
)


def packed(members: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def link(name: str, target: str) -> bytes:
    info = zipfile.ZipInfo(name)
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(info, target)
    return buffer.getvalue()


def patched(content: bytes, central: int, value: bytes) -> bytes:
    """An archive of one member with bytes of its entry in the list changed."""
    place = content.rindex(b"PK\1\2") + central
    return content[:place] + value + content[place + len(value) :]


@pytest.fixture
def library(tmp_path, cube):
    """As libraries of simulants are downloaded: fractions as folders and as archives of both kinds."""
    stl = cube.binary_stl()
    inner = {"p1.stl": stl, "p2.stl": stl}
    content = packed(
        {
            "75m/p1.stl": stl,
            "75m/p10.stl": stl,
            "75m/p2.stl": stl,
            "75-300.zip": packed(inner),
            "deep/300p.zip": packed({"all/p1.stl": stl, "again.zip": packed(inner, zipfile.ZIP_STORED)}),
            "README.txt": b"about the data",
            "__MACOSX/75m/._p1.stl": b"",
        },
        zipfile.ZIP_DEFLATED,
    )
    path = tmp_path / "JSC-1A.zip"
    path.write_bytes(content)
    return path


NAMES = [
    ("75-300", "p1"),
    ("75-300", "p2"),
    ("75m", "75m_p1"),
    ("75m", "75m_p2"),
    ("75m", "p10"),
    ("deep/300p/all", "deep_300p_all_p1"),
    ("deep/300p/again", "deep_300p_again_p1"),
    ("deep/300p/again", "deep_300p_again_p2"),
]


def test_that_members_of_archives_in_archives_keep_their_fractions_apart(library, tmp_path):
    particles = read_particles([library])
    assert [(each.group, each.name) for each in particles] == NAMES
    assert [each.mesh.volume for each in particles] == pytest.approx([1.0] * 8)
    assert list(tmp_path.iterdir()) == [library]
    before = [each.name for each in read_particles([library, library])]
    assert len(set(before)) == 16


def test_that_a_path_leads_into_an_archive(library):
    fraction = read_particles([library / "deep" / "300p.zip"])
    assert [each.group for each in fraction] == [group for group, _ in NAMES if group.startswith("deep")]
    assert read_mesh(library / "75m" / "p10.stl").source.path == str(library / "75m" / "p10.stl")
    with pytest.raises(FileError, match=rf"The archive {library.name} holds no mesh file at 500p; "):
        read_particles([library / "500p"])


def test_that_stored_archives_in_archives_and_folders_of_them_are_read(tmp_path, cube):
    inner = packed({"p.stl": cube.binary_stl()}, zipfile.ZIP_STORED)
    (tmp_path / "a.zip").write_bytes(packed({"300p.zip": inner}, zipfile.ZIP_STORED))
    (tmp_path / "b.stl").write_bytes(cube.binary_stl())
    groups = [each.group for each in read_particles([tmp_path])]
    assert groups == [f"{tmp_path.name}/a/300p", tmp_path.name]


@pytest.mark.parametrize(
    ("method", "names"),
    [(zipfile.ZIP_DEFLATED, ["p3", "p1", "p2"]), (zipfile.ZIP_STORED, ["p1", "p2", "p3"])],
)
def test_that_a_compressed_archive_in_an_archive_is_unpacked_once(method, names, tmp_path, cube):
    inner = packed({f"{name}.stl": cube.binary_stl() for name in ("p3", "p1", "p2")})
    (tmp_path / "lib.zip").write_bytes(packed({"75m.zip": inner, "300p/p0.stl": cube.binary_stl()}, method))
    files = find_files([tmp_path / "lib.zip"], [])
    assert [file.path.stem for file in files] == [*names, "p0"]


def test_that_one_bad_member_is_one_sentence(tmp_path, cube):
    stl = cube.binary_stl()
    content = packed({"a/p1.stl": stl, "a/p2.stl": b"", "b/p1.stl": stl[:300], "c.zip": b"no archive"})
    place = content.index(b"a/p1.stl") + 20
    (tmp_path / "lib.zip").write_bytes(content[:place] + b"\xff" * 8 + content[place + 8 :])
    problems: list[FileProblem] = []
    files = find_files([tmp_path / "lib.zip"], problems)
    sentences = {str(file.path.name): each.sentence for file, each in read_each(files)}
    assert [each.sentence for each in problems] == [
        "c.zip is damaged or no ZIP archive: its list of members cannot be read."
    ]
    assert len(files) == 3
    assert sentences["p2.stl"] == "p2.stl is empty: it has no bytes at all."
    assert sentences["p1.stl"].startswith("p1.stl is cut short or not an STL: it declares 12 triangles")
    damaged = next(each.sentence for _, each in read_each(files))
    assert damaged == "p1.stl is damaged in its archive; download or pack it again."


def _bomb() -> bytes:
    return packed({"p.stl": bytes(64 * 1024**2)})


def _nested(depth: int, content: bytes) -> bytes:
    for _ in range(depth):
        content = packed({"inner.zip": content})
    return content


STL = b"solid\nendsolid\n"
REFUSED = {
    "leaves the folder": (packed({"../p.stl": STL}), "“../p.stl”: its name leads out of the archive"),
    "absolute": (packed({"/etc/p.stl": STL}), "its name leads out of the archive"),
    "drive": (packed({"C:\\p.stl": STL}), "its name leads out of the archive"),
    "link": (link("p.stl", "/etc/passwd"), "it is a link, and links are not followed"),
    "password": (patched(packed({"p.stl": STL}), 8, b"\1"), "it is locked by a password"),
    "method": (patched(packed({"p.stl": STL}), 10, b"\x09"), "it is packed by method 9, which is not read"),
    "bomb": (_bomb(), "it would unpack to more than 120 times its size, as a zip bomb does"),
    "deep": (_nested(5, packed({"p.stl": STL})), "more than 4 archives in each other"),
    "cut": (packed({"p.stl": STL})[:40], "is damaged or no ZIP archive"),
    "no mesh": (packed({"table.csv": b"1,2"}), "holds no mesh file"),
    "empty": (b"", "is damaged or no ZIP archive"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_that_an_archive_made_to_do_harm_is_one_sentence(case, tmp_path):
    content, reason = REFUSED[case]
    path = tmp_path / "lib.zip"
    path.write_bytes(content)
    with pytest.raises(FileError, match=reason) as refusal:
        read_particles([path])
    assert str(refusal.value).count("\n") == 0
    assert [each.name for each in Path(tmp_path).rglob("*")] == ["lib.zip"]


def test_that_archives_beyond_the_limits_are_one_sentence_together(tmp_path, cube):
    content = packed({"p.stl": cube.binary_stl()})
    for _ in range(5):
        content = packed({"a.zip": content, "b.zip": content})
    (tmp_path / "lib.zip").write_bytes(packed({"n.zip": content, "p.stl": cube.binary_stl()}))
    problems: list[FileProblem] = []
    assert [file.path.name for file in find_files([tmp_path / "lib.zip"], problems)] == ["p.stl"]
    (problem,) = problems
    assert "“n.zip/a.zip/a.zip/a.zip/a.zip” and 15 more" in problem.sentence


def test_that_members_that_share_their_bytes_are_refused(tmp_path):
    content = packed({"p.stl": STL, "q.stl": STL})
    second = content.rindex(b"PK\1\2")
    path = tmp_path / "lib.zip"
    path.write_bytes(content[: second + 42] + bytes(4) + content[second + 46 :])
    with pytest.raises(FileError, match="members that overlap"):
        read_particles([path])


def test_that_tables_of_weights_that_do_not_count_are_noted(tmp_path, cube):
    stl = cube.binary_stl()
    packed_table = tmp_path / "packed.zip"
    packed_table.write_bytes(
        packed({"a/p1.stl": stl, "a/particles.csv": b"name,weight\np1,2\n", "b.csv": b"1"})
    )
    (tmp_path / "loose").mkdir()
    (tmp_path / "loose" / "p1.stl").write_bytes(stl)
    table = tmp_path / "loose" / "particles.csv"
    table.write_text("name,volume\np1,3\n")
    assert [file.path.name for file in find_files([packed_table], [])] == ["p1.stl"]
    assert left_out([packed_table, tmp_path / "loose"]) == [
        "loose: particles.csv has no columns name and weight with positive numbers, so every particle counts "
        "once.",
        "packed.zip: a/particles.csv is not read from an archive, so every particle counts once; unpack it "
        "to use its weights.",
    ]
    table.write_text("name,weight\np1,3\n")
    assert left_out([tmp_path / "loose"]) == []
