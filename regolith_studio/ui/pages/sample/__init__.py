"""Page "Sample": every open particle in one table, one scatter plot, and as groups with their statistics."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import ActionSpec, Page

PAGE = Page(
    key="sample",
    title=N_("Sample"),
    icon="page_sample",
    order=20,
    tip=N_("All particles: table, scatter plot, health and statistics of groups"),
    make="regolith_studio.ui.pages.sample.page:SamplePage",
    actions=(
        ActionSpec(
            "export_table", N_("E&xport table …"), icon="export", tip=N_("As a CSV file"), bar="words"
        ),
        ActionSpec("copy_table", N_("&Copy table"), tip=N_("Copy the rows for a spreadsheet")),
        ActionSpec("explore", N_("Show in &Explore"), icon="page_explore", shortcut="Ctrl+Return"),
        ActionSpec("keep", N_("&Keep only these"), tip=N_("Close all particles but the chosen rows")),
        ActionSpec(
            "match",
            N_("Co&mpare with materials …"),
            tip=N_("How near simulants, and the best mixture of them, are to this sample"),
        ),
        ActionSpec("clear_filter", N_("Clear &filter"), shortcut="Ctrl+Shift+F"),
    ),
)
