"""JSON written item by item is the JSON written at once."""

import io
from typing import Any

import pytest

from regolith_studio.session.outputs.staging import json_bytes
from regolith_studio.session.outputs.streams import JsonList

ITEMS: list[Any] = [{"name": "a\nb", "µ": [1.5, {"deep": []}]}, 7, "x", {}]


@pytest.mark.parametrize("count", [0, 1, 4])
def test_that_a_list_grows_to_the_bytes_of_the_whole(count: int) -> None:
    stream = io.BytesIO()
    grown = JsonList(stream)
    for item in ITEMS[:count]:
        grown.add(item)
    grown.close()
    assert stream.getvalue() == json_bytes(ITEMS[:count])


@pytest.mark.parametrize("count", [0, 1, 4])
def test_that_a_list_within_an_object_does_too(count: int) -> None:
    stream = io.BytesIO()
    head, tail = {"format": "f", "order": {"seed": 3}}, {"failed": ITEMS, "n": 0}
    grown = JsonList(stream, head, "items")
    for item in ITEMS[:count]:
        grown.add(item)
    grown.close(tail)
    assert stream.getvalue() == json_bytes(head | {"items": ITEMS[:count]} | tail)
