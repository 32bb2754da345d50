"""Page "Shape model": fit a stochastic model to a sample, draw virtual particles, judge both."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.model.page import ModelPage

    return ModelPage(context)


PAGE = Page(
    key="model",
    title=N_("Shape model"),
    icon="page_model",
    order=40,
    tip=N_("Draw virtual particles with the shapes and sizes of a sample"),
    make=build,
    opens=(FileKind.SHAPES,),
    actions=(
        ActionSpec(PAGE_MENU, "open_source", N_("Open a &fit, model or card …"), tip=N_("Open a source")),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "fit_model", N_("Fit the &model"), "", "F5"),
        ActionSpec(PAGE_MENU, "draw", N_("&Draw particles"), "", "Ctrl+Return"),
        ActionSpec(PAGE_MENU, "another", N_("&Another particle in the view")),
        ActionSpec(PAGE_MENU, "judge", N_("&Evaluate models")),
        ActionSpec(PAGE_MENU, "adopt", N_("&Use as population")),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "save_model", N_("&Save model …")),
        ActionSpec(PAGE_MENU, "save_card", N_("Save material &card …")),
    ),
)
