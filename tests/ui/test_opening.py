"""The size of the first particle while its unit is asked, and the chapter of the guide on each page."""

from pathlib import Path

import pytest

from regolith_studio.resources import guide_folder
from regolith_studio.ui.dialogs.guide import PAGES, as_markdown
from regolith_studio.ui.dialogs.unit import UnitDialog
from regolith_studio.ui.pages import PAGES as WINDOW_PAGES


@pytest.mark.parametrize(("length", "unit"), [(5e-5, "m"), (0.12, "mm"), (80.0, "um")])
def test_that_the_unit_that_makes_a_grain_is_suggested_with_its_size(shown, length, unit):
    dialog = shown(UnitDialog([Path("apollo_sample1.stl")], "um"))
    dialog.set_first(("apollo_sample1", length))
    assert dialog.value() == unit
    size = {"m": "50.0", "mm": "120", "um": "80.0"}[unit]
    assert dialog.size_note.text().startswith(f"apollo_sample1 would be {size}")


def test_that_every_page_has_a_chapter_of_the_guide_without_directives():
    assert set(PAGES) == set(WINDOW_PAGES)
    for name in PAGES.values():
        text = as_markdown((guide_folder() / f"{name}.md").read_text(encoding="utf-8"))
        assert "{doc}" not in text
    assert as_markdown("see {doc}`views` and {doc}`more <harmonics>`") == (
        "see [views](views.md) and [more](harmonics.md)"
    )
