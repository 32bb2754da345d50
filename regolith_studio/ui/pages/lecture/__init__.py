"""Page "Lecture": the paper's ideas step by step, large enough for the last row."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import ActionSpec, Page

PAGE = Page(
    key="lecture",
    title=N_("Lecture"),
    icon="page_lecture",
    order=90,
    tip=N_("Annealing step by step, l_max growing, a random field on the sphere; large letters"),
    make="regolith_studio.ui.pages.lecture.page:LecturePage",
    actions=(
        ActionSpec(
            "play",
            N_("&Play or pause"),
            icon="play",
            shortcut="Ctrl+Space",
            tip=N_("Step by step"),
            bar="words",
        ),
        ActionSpec("back", N_("Step &back"), shortcut="PgUp"),
        ActionSpec("forward", N_("Step &forward"), shortcut="PgDown", tip=N_("One step")),
        ActionSpec(
            "another",
            N_("&Another seed"),
            icon="dice",
            shortcut="Ctrl+Return",
            tip=N_("Another seed"),
            bar="words",
        ),
        ActionSpec("larger", N_("&Larger letters"), shortcut="Ctrl++"),
        ActionSpec("smaller", N_("S&maller letters"), shortcut="Ctrl+-"),
        ActionSpec("full_screen", N_("F&ull screen"), shortcut="F11", tip=N_("Full screen on or off")),
    ),
)
