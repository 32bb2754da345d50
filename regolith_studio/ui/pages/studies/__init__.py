"""Page "Studies": the paper's figures 3, 7 and 8 for the particles that are open."""

from regolith_studio.ui.action_spec import PAGE_MENU, ActionSpec
from regolith_studio.ui.page import Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.studies.page import StudiesPage

    return StudiesPage(context)


PAGE = Page(
    key="studies",
    title="Studies",
    icon="page_studies",
    order=45,
    tip="RMSRE against l_max and for each loss, and what the polyhedra look like",
    build=build,
    actions=(
        ActionSpec(PAGE_MENU, "run_all", "&Compute all", "play", "Ctrl+Return", "All three", bar="words"),
        ActionSpec(
            PAGE_MENU,
            "save",
            "&Save figures and tables …",
            "export",
            "",
            "CSV, JSON, PNG",
            None,
            "words",
        ),
    ),
)
