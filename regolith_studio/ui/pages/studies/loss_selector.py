"""Selection of the losses in the rows of figures 7 and 8, and of the bounding box of diameters."""

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtGui import QAction, QMouseEvent
from PySide6.QtWidgets import QMenu, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from regolith_studio.messages import N_
from regolith_studio.session.choices import Choices
from regolith_studio.session.study_requests import loss_names
from regolith_studio.studies.loss_variants import ALONE, PAPER_LOSSES
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.combo_box import ChoiceBox
from regolith_studio.ui.widgets.fixed_height_text import FixedHeightText
from regolith_studio.ui.widgets.labels import heading, remark

ARROW = "  ▾"
BOXES = {"exact": N_("exact minimum volume"), "trimesh": N_("trimesh's heuristic")}
BOX_TIP = N_(
    "Diameters and aspect ratio come from this box. The heuristic is no minimum; "
    "it is offered for comparison."
)

EQUAL_TIP = N_("Losses can be compared at equal numbers of facets only; choose the number beside Facets n.")


class LossSelector(QWidget):
    """The controls of the studies."""

    valueChanged = Signal()  # noqa: N815

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("study_loss_selector")
        self._actions: dict[str, QAction] = {}
        self.rows = QToolButton()
        self.rows.setObjectName("study_rows")
        self.rows.setAccessibleName(tr("Losses of the studies"))
        self.rows.setToolTip(tr("Loss functions that are the rows of the studies"))
        self.rows.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.menu = self._menu()
        self.rows.clicked.connect(self._open)
        self.box = ChoiceBox("study_box", tr("Bounding box of the diameters"), BOXES)
        self.box.setMinimumContentsLength(max(len(tr(each)) for each in BOXES.values()))
        self.box.setToolTip(tr(BOX_TIP))
        self.remark = remark()
        self.remark.setObjectName("study_facets_remark")
        self.remark.setToolTip(tr(EQUAL_TIP))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for part in (
            heading(tr("Loss functions")),
            self.rows,
            heading(tr("Bounding box")),
            self.box,
            FixedHeightText((self.remark,)),
        ):
            column.addWidget(part)
        self.box.currentIndexChanged.connect(lambda _index: self.valueChanged.emit())
        self.set_names(PAPER_LOSSES)

    def names(self) -> tuple[str, ...]:
        """Keys of the selected losses in the order of the menu, at least one."""
        return tuple(name for name, action in self._actions.items() if action.isChecked())

    def set_names(self, names: Sequence[str]) -> None:
        """Select other losses; unknown ones are ignored, and none means those of Fig. 8."""
        known = [name for name in names if name in self._actions] or PAPER_LOSSES
        for wanted in (True, False):  # never none in between
            for name, action in self._actions.items():
                if (name in known) is wanted:
                    action.setChecked(wanted)
        self._update_text()

    def show_facets(self, choices: Choices) -> None:
        """Show the number of facets of the studies if polyhedra stop at an error."""
        stops = choices.stop_at == "error"
        words = tr("compared at {count} facets each", count=choices.facet_count)
        self.remark.setText(words if stops else "")

    def _menu(self) -> QMenu:
        menu = _StickyMenu(self)
        menu.setObjectName("study_rows_menu")
        for words, names in (
            (tr("Standard set"), PAPER_LOSSES),
            (tr("Each term alone"), ("overlap", *(name for name in loss_names() if name.startswith(ALONE)))),
        ):
            menu.addAction(words).triggered.connect(partial(self._choose, names))
        menu.addSeparator()
        for name, label in loss_names().items():
            action = menu.addAction(translate(label))
            action.setCheckable(True)
            action.toggled.connect(partial(self._toggled, name))
            self._actions[name] = action
        return menu

    def _open(self) -> None:
        """Show the menu without blocking, unlike the menu of a button."""
        self.menu.popup(self.rows.mapToGlobal(self.rows.rect().bottomLeft()))

    def _choose(self, names: Sequence[str], _checked: bool = False) -> None:
        self.set_names(names)
        self.valueChanged.emit()

    def _toggled(self, name: str, _on: bool) -> None:
        if not self.names():  # the last one stays
            self._actions[name].setChecked(True)
            return
        self._update_text()
        self.valueChanged.emit()

    def _update_text(self) -> None:
        names = self.names()
        words = tr("{count} losses", count=len(names))
        if names == tuple(name for name in self._actions if name in PAPER_LOSSES):
            words = tr("Standard set")
        elif len(names) == 1:
            words = self._actions[names[0]].text()
        self.rows.setText(words + ARROW)


class _StickyMenu(QMenu):
    """Stays open while its entries are checked, so that several can be chosen."""

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        action = self.actionAt(event.position().toPoint())
        if action is not None and action.isCheckable():
            action.trigger()
            return
        super().mouseReleaseEvent(event)
