"""Every symbol has its definition and the number of its equation as a tool tip."""

import numpy as np
import pytest
from PySide6.QtCore import Qt

from regolith_studio.coarsening.weights import JACCARD
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.ui.pages.explore.page import ParticleListPanel
from regolith_studio.ui.pages.explore.panels import weight_spec
from regolith_studio.ui.pages.explore.plots import DescriptorTablePanel
from regolith_studio.ui.widgets.heat_table import HeatTable
from regolith_studio.ui.widgets.labels import plain_symbol
from regolith_studio.ui.widgets.table import definition, particle_columns

pytestmark = pytest.mark.usefixtures("app")


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("volume", "V, Volume: volume that the surface encloses"),
        ("sphericity", "S, Sphericity: π^(1/3) (6V)^(2/3) / A (Wadell, true sphericity) (Eq. 1)"),
        ("min_diameter", "Dₘᵢₙ, Minimum diameter: shortest edge of the bounding box"),
        ("aspect_ratio", "AR, Aspect ratio: Dₘₐₓ / Dₘᵢₙ (Eq. 2)"),
    ],
)
def test_that_a_definition_has_symbol_name_formula_and_equation(key, words):
    assert definition(key) == words


def test_that_no_definition_only_repeats_its_symbol():
    for key in (*CATALOGUE, JACCARD):
        symbol, _, formula = definition(key).partition(":")
        assert formula.strip() not in ("", symbol.partition(",")[0]), key


def test_that_tables_bars_and_weights_define_their_symbols(shown):
    table = shown(DescriptorTablePanel())
    for row, key in enumerate(table._keys):
        assert table.table.verticalHeaderItem(row).toolTip() == definition(key)
    found = {each.key: each.tip for each in particle_columns()}
    assert all(found[key] == definition(key) for key in LOSS_KEYS)
    model = ParticleListPanel()
    shown(model)
    heads = [
        model.table.model().headerData(at, Qt.Orientation.Horizontal, Qt.ItemDataRole.ToolTipRole)
        for at in range(2, 5)
    ]
    assert heads == [definition(key) for key in ("volume", "sphericity", "aspect_ratio")]
    assert all(definition(key) in weight_spec(key).tip for key in (*LOSS_KEYS, JACCARD))
    heat = shown(HeatTable(""))
    heat.set_values(["a"], [plain_symbol("S")], np.array([[0.1]]), tips=[definition("sphericity")])
    assert heat.table.horizontalHeaderItem(0).toolTip() == definition("sphericity")
