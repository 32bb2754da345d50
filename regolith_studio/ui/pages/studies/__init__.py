"""Page "Studies": the paper's figures 3, 7 and 8 for the particles that are open."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import ActionSpec, Page

PAGE = Page(
    key="studies",
    title=N_("Studies"),
    icon="page_studies",
    order=45,
    tip=N_("Errors against l_max, facets and weights, and the polyhedra"),
    make="regolith_studio.ui.pages.studies.page:StudiesPage",
    actions=(
        ActionSpec("run_shown", N_("Compute this s&tudy"), shortcut="F5", tip=N_("That of the open tab")),
        ActionSpec(
            "run_all",
            N_("&Compute all"),
            icon="play",
            shortcut="Ctrl+Return",
            tip=N_("Every study and the gallery"),
            bar="words",
        ),
        ActionSpec(
            "save",
            N_("&Save figures and tables …"),
            icon="export",
            tip=N_("CSV, JSON, PNG, SVG"),
            bar="words",
        ),
    ),
)
