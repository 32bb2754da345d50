"""The published JSON Schema is the one that the program checks by."""

import json
from pathlib import Path

import pytest

from regolith_studio.dataset.folder_io import write_dataset
from regolith_studio.dataset.schema import json_schema, main, schema_text
from regolith_studio.resources import resource


def test_that_the_published_schema_is_up_to_date(tmp_path: Path) -> None:
    published = resource("schema", "dataset.schema.json").read_text(encoding="utf-8")
    assert published == schema_text(), "run python -m regolith_studio.dataset.schema resources/schema/..."
    assert main([str(tmp_path / "schema.json")]) == 0
    assert (tmp_path / "schema.json").read_text(encoding="utf-8") == published
    assert main([]) == 2


def test_that_it_is_of_draft_2020_12_and_forbids_unknown_fields_everywhere() -> None:
    schema = json_schema()
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    records = [schema, *schema["$defs"].values()]
    assert all(record["additionalProperties"] is False for record in records if record["type"] == "object")


def test_that_every_length_says_its_unit() -> None:
    def keys(node):
        if isinstance(node, dict):
            yield from node.get("properties", {})
            for inner in node.values():
                yield from keys(inner)
        elif isinstance(node, list):
            for inner in node:
                yield from keys(inner)

    found = set(keys(json.loads(schema_text())))
    assert {"centroid_um", "scale_um", "diameters_um", "median_um", "length_unit"} <= found
    assert not {"diameters", "centroid", "scale", "median"} & found


def test_that_a_stranger_s_checker_admits_what_is_written_and_refuses_what_is_not(
    tmp_path: Path, make_dataset
) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    document = json.loads((write_dataset(tmp_path / "set", make_dataset(2)) / "dataset.json").read_text())
    checker = jsonschema.Draft202012Validator(json_schema())
    checker.check_schema(json_schema())
    assert list(checker.iter_errors(document)) == []
    for change in ({"extra": 1}, {"schema_version": 1}, {"weighting": "mass"}, {"representatives": []}):
        assert list(checker.iter_errors(document | change))
