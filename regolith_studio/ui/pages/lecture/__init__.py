"""Page "Lecture": the paper's ideas step by step, large enough for the last row."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.lecture.page import LecturePage

    return LecturePage(context)


PAGE = Page(
    key="lecture",
    title=N_("Lecture"),
    icon="page_lecture",
    order=90,
    tip=N_("Annealing step by step, l_max growing, a random field on the sphere; large letters"),
    make=build,
    actions=(
        ActionSpec(
            PAGE_MENU, "play", N_("&Play or pause"), "play", "Ctrl+Space", N_("Step by step"), bar="words"
        ),
        ActionSpec(PAGE_MENU, "back", N_("Step &back"), "", "PgUp"),
        ActionSpec(PAGE_MENU, "forward", N_("Step &forward"), "", "PgDown", N_("One step")),
        ActionSpec(
            PAGE_MENU, "another", N_("&Another seed"), "dice", "Ctrl+Return", N_("Another seed"), bar="words"
        ),
        ActionSpec(PAGE_MENU, "larger", N_("&Larger letters"), "", "Ctrl++"),
        ActionSpec(PAGE_MENU, "smaller", N_("S&maller letters"), "", "Ctrl+-"),
        ActionSpec(PAGE_MENU, "full_screen", N_("F&ull screen"), "", "F11", N_("Full screen on or off")),
    ),
)
