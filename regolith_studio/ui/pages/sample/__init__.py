"""Page "Sample": every open particle in one table, one scatter plot, and as groups with their statistics."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.sample.page import SamplePage

    return SamplePage(context)


PAGE = Page(
    key="sample",
    title=N_("Sample"),
    icon="page_sample",
    order=20,
    tip=N_("All particles: table, scatter plot, health and statistics of groups"),
    make=build,
    actions=(
        ActionSpec(
            PAGE_MENU, "export_table", N_("E&xport table …"), "export", tip=N_("As a CSV file"), bar="words"
        ),
        ActionSpec(PAGE_MENU, "copy_table", N_("&Copy table"), "", "", N_("Copy the rows for a spreadsheet")),
        ActionSpec(PAGE_MENU, "explore", N_("Show in &Explore"), "page_explore", "Ctrl+Return"),
        ActionSpec(
            PAGE_MENU, "keep", N_("&Keep only these"), "", "", N_("Close all particles but the chosen rows")
        ),
        ActionSpec(PAGE_MENU, "clear_filter", N_("Clear &filter"), "", "Ctrl+Shift+F"),
    ),
)
