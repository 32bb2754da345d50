"""Page "Scan": from a volume of grey values or labels to particles."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, ActionSpec, Page

PAGE = Page(
    key="scan",
    title=N_("Scan"),
    icon="page_scan",
    order=30,
    tip=N_("Find the grains in a CT volume and make particles of them"),
    make="regolith_studio.ui.pages.scan.page:ScanPage",
    opens=(FileKind.VOLUME,),
    actions=(
        ActionSpec(
            "open_volume",
            N_("Open &volume …"),
            icon="open",
            shortcut="Ctrl+Alt+O",
            tip=N_("Open a CT volume"),
        ),
        ActionSpec("open_slices", N_("Open a folder of s&lices …")),
        ActionSpec("sample_volume", N_("Open the sample &scan"), icon="sample"),
        ActionSpec(
            "gradient_volume",
            N_("Open the sample scan for the br&ush"),
            tip=N_("Open the second sample scan, whose grey values no threshold segments"),
        ),
        ActionSpec(BREAK),
        ActionSpec("open_settings", N_("Open se&ttings …"), tip=N_("Load settings from a file")),
        ActionSpec("save_settings", N_("Sa&ve settings …"), tip=N_("Write settings for the next scan")),
        ActionSpec(BREAK),
        ActionSpec(
            "find_grains", N_("&Find grains"), icon="play", shortcut="F5", tip=N_("Segment the whole volume")
        ),
        ActionSpec(
            "save_labels",
            N_("Save la&bels …"),
            tip=N_("Write the volume of labels and a table of them for other programs"),
        ),
        ActionSpec(
            "make_particles",
            N_("&Make particles"),
            shortcut="Ctrl+Return",
            tip=N_("Open the grains as particles"),
        ),
    ),
)
