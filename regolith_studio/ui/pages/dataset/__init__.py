"""Page "Dataset": particles that stand for all, their sizes, the folder, and its way to DEM programs."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, ActionSpec, Page

PAGE = Page(
    key="dataset",
    title=N_("Dataset"),
    icon="page_dataset",
    order=60,
    tip=N_("Choose representative particles, build a dataset, export it to DEM programs"),
    make="regolith_studio.ui.pages.dataset.page:DatasetPage",
    opens=(FileKind.DATASET,),
    actions=(
        ActionSpec("find", N_("&Find representatives"), shortcut="F5"),
        ActionSpec("open_dataset", N_("&Open a dataset …")),
        ActionSpec("validate", N_("&Check the dataset")),
        ActionSpec(BREAK),
        ActionSpec("export", N_("&Export to DEM programs …"), shortcut="Ctrl+Return"),
    ),
)
