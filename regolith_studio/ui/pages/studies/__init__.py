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
    tip="Errors against l_max, facets and weights, and what the polyhedra look like",
    make=build,
    actions=(
        ActionSpec(
            PAGE_MENU,
            "run_all",
            "&Compute all",
            "play",
            "Ctrl+Return",
            "Every study and the gallery",
            bar="words",
        ),
        ActionSpec(
            PAGE_MENU,
            "save",
            "&Save figures and tables …",
            "export",
            "",
            "CSV, JSON, PNG, SVG",
            None,
            "words",
        ),
    ),
)
