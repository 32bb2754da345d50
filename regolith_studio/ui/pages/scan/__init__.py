"""Page "Scan": from a volume of grey values or labels to particles."""

from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.action_spec import BREAK, PAGE_MENU, ActionSpec
from regolith_studio.ui.page import Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.scan.page import ScanPage

    return ScanPage(context)


PAGE = Page(
    key="scan",
    title="Scan",
    icon="page_scan",
    order=30,
    tip="Find the grains in a CT volume and make particles of them",
    make=build,
    opens=(FileKind.VOLUME,),
    actions=(
        ActionSpec(PAGE_MENU, "open_volume", "Open &volume …", "open", "Ctrl+Alt+O", "Open a CT volume"),
        ActionSpec(PAGE_MENU, "open_slices", "Open a folder of s&lices …"),
        ActionSpec(PAGE_MENU, "sample_volume", "Open the sample &scan", "sample"),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "open_settings", "Open se&ttings …", tip="Take settings from a file"),
        ActionSpec(PAGE_MENU, "save_settings", "Sa&ve settings …", tip="Write settings for the next scan"),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "find_grains", "&Find grains", "play", "F5", "Segment the whole volume"),
        ActionSpec(PAGE_MENU, "make_particles", "&Make particles", tip="Hand the grains to all other pages"),
    ),
)
