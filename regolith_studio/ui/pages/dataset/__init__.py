"""Page "Dataset": particles that stand for all, their sizes, the folder, and its way to DEM programs."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, PAGE_MENU, ActionSpec, Page, PageContext, PageWidget


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.dataset.page import DatasetPage

    return DatasetPage(context)


PAGE = Page(
    key="dataset",
    title=N_("Dataset"),
    icon="page_dataset",
    order=60,
    tip=N_("Choose representative particles, build a dataset, export it to DEM programs"),
    make=build,
    opens=(FileKind.DATASET,),
    actions=(
        ActionSpec(PAGE_MENU, "find", N_("&Find representatives"), "", "F5"),
        ActionSpec(PAGE_MENU, "build", N_("&Build the dataset …"), "", "Ctrl+Return"),
        ActionSpec(PAGE_MENU, "open_dataset", N_("&Open a dataset …")),
        ActionSpec(PAGE_MENU, "validate", N_("&Check the dataset")),
        ActionSpec(PAGE_MENU, BREAK, ""),
        ActionSpec(PAGE_MENU, "export", N_("&Export to DEM programs …"), "", "Ctrl+Shift+E"),
        ActionSpec(PAGE_MENU, "library", N_("Show the &library")),
    ),
)
