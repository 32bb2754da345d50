"""Page "Studies": the paper's figures 3, 7 and 8 for the particles that are open."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.studies.page import StudiesPage

    return StudiesPage(context)


PAGE = Page(
    key="studies",
    title=N_("Studies"),
    icon="page_studies",
    order=45,
    tip=N_("Errors against l_max, facets and weights, and the polyhedra"),
    make=build,
    actions=(
        ActionSpec(
            PAGE_MENU,
            "run_all",
            N_("&Compute all"),
            "play",
            "Ctrl+Return",
            N_("Every study and the gallery"),
            bar="words",
        ),
        ActionSpec(
            PAGE_MENU,
            "save",
            N_("&Save figures and tables …"),
            "export",
            "",
            N_("CSV, JSON, PNG, SVG"),
            None,
            "words",
        ),
    ),
)
