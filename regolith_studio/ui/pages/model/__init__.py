"""Page "Shape model": fit a stochastic model to a sample, draw virtual particles, judge both."""

from regolith_studio.messages import N_
from regolith_studio.session.file_kinds import FileKind
from regolith_studio.ui.page import BREAK, ActionSpec, Page

PAGE = Page(
    key="model",
    title=N_("Shape model"),
    icon="page_model",
    order=40,
    tip=N_("Draw virtual particles with the shapes and sizes of a sample"),
    make="regolith_studio.ui.pages.model.page:ModelPage",
    opens=(FileKind.SHAPES,),
    actions=(
        ActionSpec("open_source", N_("Open a &fit, model or card …"), tip=N_("Open a source")),
        ActionSpec(BREAK),
        ActionSpec("fit_model", N_("Fit the &model"), shortcut="F5"),
        ActionSpec("draw", N_("&Draw particles"), shortcut="Ctrl+Return"),
        ActionSpec("another", N_("&Another particle in the view")),
        ActionSpec("judge", N_("&Evaluate models")),
        ActionSpec("adopt", N_("&Use as population")),
        ActionSpec(BREAK),
        ActionSpec("save_model", N_("&Save model …")),
        ActionSpec("save_card", N_("Save material &card …")),
    ),
)
