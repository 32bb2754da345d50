"""3MF archives: placements, components, and archives made to harm."""

import io
import re
import zipfile
from pathlib import Path

import pytest

from regolith_studio.readers.sandbox.tasks import parse_mesh

CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
MESH = "<mesh><vertices>"
MESH += "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in CORNERS) + "</vertices><triangles>"
MESH += "".join(
    f'<triangle v1="{a}" v2="{b}" v3="{c}"/><triangle v1="{a}" v2="{c}" v3="{d}"/>' for a, b, c, d in QUADS
)
MESH += "</triangles></mesh>"
CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"


def archive(model, name="3D/3dmodel.model", compression=zipfile.ZIP_DEFLATED):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", compression) as file:
        file.writestr(name, model)
    return data.getvalue()


def model(build='<item objectid="1"/>', resources=f'<object id="1">{MESH}</object>', unit="micron"):
    head = f'<?xml version="1.0"?><model unit="{unit}" xmlns="{CORE}">'
    return f"{head}<resources>{resources}</resources><build>{build}</build></model>"


def test_that_a_cube_in_a_3mf_has_volume_one_and_states_its_unit(accepted):
    particle = accepted("cube.3mf", archive(model()))
    assert particle.mesh.volume == pytest.approx(1.0)
    assert particle.notes == ("The file states its unit: micron.",)


def test_that_placements_and_components_are_transformed(accepted):
    """Scaled by 2 as a component, moved by 10 as an item; rows of the matrix are images of the axes."""
    resources = f'<object id="1">{MESH}</object><object id="2"><components>'
    resources += '<component objectid="1" transform="2 0 0 0 2 0 0 0 2 0 0 0"/></components></object>'
    build = '<item objectid="2" transform="0 1 0 -1 0 0 0 0 1 10 0 0"/>'
    mesh = accepted("cube.3mf", archive(model(build, resources))).mesh
    assert mesh.volume == pytest.approx(8.0)
    assert mesh.bounds.tolist() == [[8, 0, 0], [10, 2, 2]]


def test_that_each_object_of_another_part_is_built_once():
    """The production extension, as slicing programs save projects: objects in a part of their own."""
    production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
    objects = f'<object id="1">{MESH}</object><object id="2">{MESH}</object>'
    components = "".join(
        f'<component p:path="/3D/parts.model" objectid="{key}" transform="1 0 0 0 1 0 0 0 1 {10 * key} 0 0"/>'
        for key in (1, 2)
    )
    root = model('<item objectid="3"/>', f'<object id="3"><components>{components}</components></object>')
    data = io.BytesIO(archive(root.replace(" xmlns=", f' xmlns:p="{production}" xmlns=', 1)))
    with zipfile.ZipFile(data, "a") as file:
        file.writestr("3D/parts.model", model("", objects))
    parsed, _ = parse_mesh(data.getvalue(), Path("cubes.3mf"))
    assert (len(parsed.vertices), len(parsed.faces)) == (16, 24)
    assert parsed.vertices[:, 0].tolist() == [10] * 4 + [11] * 4 + [20] * 4 + [21] * 4


BOMB = archive(b"\0" * (1 << 26))
CIRCLE = '<object id="1"><components><component objectid="1"/></components></object>'

BAD = {
    "no archive": (b"PK\3\4 but no archive", "archive is damaged"),
    "half an archive": (archive(model())[:200], "archive is damaged"),
    "no model": (archive("hello", "readme.txt"), "holds no model"),
    "broken XML": (archive(model()[:-20]), "XML of its model is broken"),
    "an empty model": (archive(model("", "")), "builds no triangles"),
    "nothing built": (archive(model("")), "builds no triangles"),
    "an object that is not there": (archive(model('<item objectid="9"/>')), "object “9”, which is not there"),
    "components in a circle": (archive(model(resources=CIRCLE)), "form a cycle"),
    "a part that unpacks to 64 MiB": (BOMB, "unpacks to 67 MB, 100 times its size or more"),
    "entities": (archive('<?xml version="1.0"?><!DOCTYPE m [<!ENTITY a "b">]><model/>'), "defines entities"),
    "a word for a number": (
        archive(model().replace('x="1"', 'x="one"', 1)),
        "its model has “one” where a number belongs",
    ),
    "no third corner": (
        archive(model().replace('v3="3"', "", 1)),
        "lacks the attribute “v3” of a vertex or triangle",
    ),
    "an index too high": (archive(model().replace('v3="3"', 'v3="8"', 1)), "points beyond the 8 vertices"),
    "a transformation of five numbers": (
        archive(model('<item objectid="1" transform="1 2 3 4 5"/>')),
        "a number or a matrix in its model is not what it should be",
    ),
}


@pytest.mark.parametrize("kind", BAD)
def test_that_a_bad_3mf_is_refused_with_one_sentence_that_says_why(kind, refusal):
    data, expected = BAD[kind]
    assert re.search(expected, refusal("bad.3mf", data))
