"""JSON is read strictly, and written to the same bytes in every way."""

import io
import json
import math
from typing import Any

import pytest

from regolith_studio.io.own_files import JsonListWriter, canonical_json, json_bytes, parse_strict_json

ITEMS: list[Any] = [{"name": "a\nb", "µ": [1.5, {"deep": []}]}, 7, "x", {}]


@pytest.mark.parametrize("count", [0, 1, 4])
def test_that_a_list_grows_to_the_bytes_of_the_whole(count: int) -> None:
    stream = io.BytesIO()
    writer = JsonListWriter(stream)
    for item in ITEMS[:count]:
        writer.add(item)
    writer.close()
    assert stream.getvalue() == json_bytes(ITEMS[:count])


@pytest.mark.parametrize("count", [0, 1, 4])
def test_that_a_list_within_an_object_does_too(count: int) -> None:
    stream = io.BytesIO()
    head, tail = {"format": "f", "order": {"seed": 3}}, {"failed": ITEMS, "n": 0}
    writer = JsonListWriter(stream, head, "items")
    for item in ITEMS[:count]:
        writer.add(item)
    writer.close(tail)
    assert stream.getvalue() == json_bytes(head | {"items": ITEMS[:count]} | tail)


def test_that_canonical_json_keeps_every_bit_and_sorts_keys() -> None:
    value = {"b": [0.1, 1e-300, 5e-324, -0.0, 1 / 3], "a": {"x": [[1.5], []], "y": None, "z": {}}, "ü": "\n"}
    text = canonical_json(value)
    assert parse_strict_json(text, "text") == value
    assert text.index('"a"') < text.index('"b"')
    assert text.isascii()
    with pytest.raises(ValueError, match="not JSON compliant"):
        canonical_json({"x": float("inf")})


def test_that_json_holds_no_number_that_other_programs_cannot_read() -> None:
    assert json.loads(json_bytes({"µ": [0.1]})) == {"µ": [0.1]}
    with pytest.raises(ValueError, match="JSON compliant"):
        json_bytes([math.nan])
