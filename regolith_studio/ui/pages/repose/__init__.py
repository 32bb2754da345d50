"""Page "Angle of repose": set up the lifting cylinder, watch it, measure the heap, compare runs."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, ActionSpec, Page

PAGE = Page(
    key="repose",
    title=N_("Angle of repose"),
    icon="page_repose",
    order=70,
    tip=N_("Fill a cylinder with the particles of a dataset, lift it, measure the heap"),
    make="regolith_studio.ui.pages.repose.page:ReposePage",
    opens=(FileKind.POSITIONS,),
    actions=(
        ActionSpec("open_dataset", N_("Open a &dataset …"), tip=N_("Choose the dataset to simulate")),
        ActionSpec(
            "make_dataset",
            N_("Use the &open particles"),
            shortcut="F5",
            tip=N_("Coarsen the open particles first"),
        ),
        ActionSpec(BREAK),
        ActionSpec("run_test", N_("&Run the test"), icon="play", shortcut="Ctrl+Return", bar="words"),
        ActionSpec("start_study", N_("Start the &study"), tip=N_("Start the study, or resume it")),
        ActionSpec(
            "start_calibration",
            N_("Start the &calibration"),
            tip=N_("Find the friction that gives a wanted angle, or resume it"),
        ),
        ActionSpec("play", N_("&Play the run")),
        ActionSpec(BREAK),
        ActionSpec(
            "open_positions", N_("&Measure positions …"), tip=N_("Measure the heap of another program")
        ),
        ActionSpec("export_run", N_("&Export figure and JSON …"), icon="export"),
        ActionSpec(
            "export_heap",
            N_("Export for Para&View and OVITO …"),
            tip=N_("Write all moments of the shown run for ParaView and OVITO, and the last one as GLB"),
        ),
        ActionSpec("choose_folder", N_("Folder of r&uns …")),
    ),
)
