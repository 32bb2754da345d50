"""Page "Angle of repose": set up the lifting cylinder, watch it, measure the pile, compare runs."""

from regolith_studio.messages import N_
from regolith_studio.ui.page import BREAK, PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.repose.page import ReposePage

    return ReposePage(context)


PAGE = Page(
    key="repose",
    title=N_("Angle of repose"),
    icon="page_repose",
    order=70,
    tip=N_("Fill a cylinder with the particles of a dataset, lift it, measure the pile"),
    make=build,
    actions=(
        ActionSpec(
            PAGE_MENU, "open_dataset", N_("Open a &dataset …"), tip=N_("Choose the dataset to simulate")
        ),
        ActionSpec(
            PAGE_MENU,
            "make_dataset",
            N_("Use the &open particles"),
            "",
            "F5",
            N_("Coarsen the open particles first"),
        ),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "run_test", N_("&Run the test"), "play", "Ctrl+Return", bar="words"),
        ActionSpec(PAGE_MENU, "start_study", N_("Start the &study"), tip=N_("Start the study, or resume it")),
        ActionSpec(
            PAGE_MENU,
            "start_calibration",
            N_("Start the &calibration"),
            tip=N_("Find the friction that gives a wanted angle, or resume it"),
        ),
        ActionSpec(PAGE_MENU, "play", N_("&Play the run")),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(
            PAGE_MENU,
            "open_positions",
            N_("&Measure positions …"),
            tip=N_("Measure the pile of another program"),
        ),
        ActionSpec(PAGE_MENU, "export_run", N_("&Export figure and JSON …"), "export"),
        ActionSpec(
            PAGE_MENU,
            "export_heap",
            N_("Export for Para&View and OVITO …"),
            tip=N_("Write all moments of the shown run for ParaView and OVITO, and the last one as GLB"),
        ),
        ActionSpec(PAGE_MENU, "choose_folder", N_("Folder of r&uns …")),
    ),
)
