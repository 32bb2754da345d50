"""Page "Lecture": the paper's ideas step by step, large enough for the last row."""

from regolith_studio.ui.action_spec import PAGE_MENU, ActionSpec
from regolith_studio.ui.page import Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.lecture.page import LecturePage

    return LecturePage(context)


PAGE = Page(
    key="lecture",
    title="Lecture",
    icon="page_lecture",
    order=90,
    tip="Annealing step by step, l_max growing, a random field on the sphere; large letters",
    make=build,
    actions=(
        ActionSpec(PAGE_MENU, "play", "&Play or pause", "play", "Ctrl+Space", "Step by step", bar="words"),
        ActionSpec(PAGE_MENU, "back", "Step &back", "", "PgUp"),
        ActionSpec(PAGE_MENU, "forward", "Step &forward", "", "PgDown", "One step"),
        ActionSpec(PAGE_MENU, "another", "&Another one", "dice", "Ctrl+Return", "Another seed", bar="words"),
        ActionSpec(PAGE_MENU, "larger", "&Larger letters", "", "Ctrl++"),
        ActionSpec(PAGE_MENU, "smaller", "S&maller letters", "", "Ctrl+-"),
        ActionSpec(PAGE_MENU, "full_screen", "F&ull screen", "", "F11", "And back"),
    ),
)
