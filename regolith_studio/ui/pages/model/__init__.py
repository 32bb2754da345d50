"""Page "Shape model": fit a stochastic model to a sample, draw virtual particles, judge both."""

from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.action_spec import BREAK, PAGE_MENU, ActionSpec
from regolith_studio.ui.page import Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.model.page import ModelPage

    return ModelPage(context)


PAGE = Page(
    key="model",
    title="Shape model",
    icon="page_model",
    order=40,
    tip="Draw virtual particles with the shapes and sizes of a sample",
    make=build,
    opens=(FileKind.SHAPES,),
    actions=(
        ActionSpec(PAGE_MENU, "open_source", "Open a &fit, model or card …", tip="Open what to draw from"),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "fit_model", "Fit the &model"),
        ActionSpec(PAGE_MENU, "draw", "&Draw particles"),
        ActionSpec(PAGE_MENU, "another", "&Another particle in the view"),
        ActionSpec(PAGE_MENU, "judge", "&Judge models"),
        ActionSpec(PAGE_MENU, "adopt", "&Use as population"),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "save_model", "&Save model …"),
        ActionSpec(PAGE_MENU, "save_card", "Save material &card …"),
    ),
)
