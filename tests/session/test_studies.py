"""Kinds of studies: each knows the function that writes its files."""

from pkgutil import resolve_name

import pytest

from regolith_studio.session.outputs.studies import FIGURES, STUDIES


@pytest.mark.parametrize("key", STUDIES)
def test_that_the_writer_of_each_kind_of_study_exists(key: str) -> None:
    name = STUDIES[key].write.args[0]  # type: ignore[attr-defined]  # a partial of the name and what goes with it
    assert callable(resolve_name(f"{FIGURES}.{name}"))
