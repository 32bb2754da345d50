"""Page "Scan": from a volume of grey values or labels to particles."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.scan.page import ScanPage

    return ScanPage(context)


PAGE = Page(
    key="scan",
    title=N_("Scan"),
    icon="page_scan",
    order=30,
    tip=N_("Find the grains in a CT volume and make particles of them"),
    make=build,
    opens=(FileKind.VOLUME,),
    actions=(
        ActionSpec(
            PAGE_MENU, "open_volume", N_("Open &volume …"), "open", "Ctrl+Alt+O", N_("Open a CT volume")
        ),
        ActionSpec(PAGE_MENU, "open_slices", N_("Open a folder of s&lices …")),
        ActionSpec(PAGE_MENU, "sample_volume", N_("Open the sample &scan"), "sample"),
        ActionSpec(
            PAGE_MENU,
            "gradient_volume",
            N_("Open the sample scan for the br&ush"),
            tip=N_("Open the second sample scan, whose grey values no threshold segments"),
        ),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "open_settings", N_("Open se&ttings …"), tip=N_("Load settings from a file")),
        ActionSpec(
            PAGE_MENU, "save_settings", N_("Sa&ve settings …"), tip=N_("Write settings for the next scan")
        ),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(
            PAGE_MENU, "find_grains", N_("&Find grains"), "play", "F5", N_("Segment the whole volume")
        ),
        ActionSpec(
            PAGE_MENU,
            "save_labels",
            N_("Save la&bels …"),
            tip=N_("Write the volume of labels and a table of them for other programs"),
        ),
        ActionSpec(
            PAGE_MENU,
            "make_particles",
            N_("&Make particles"),
            "",
            "Ctrl+Return",
            N_("Open the grains as particles"),
        ),
    ),
)
