"""A form for Tables 1 and 2 with presets: the paper's values, and those that the user has saved."""

from collections.abc import Mapping
from typing import Any

from PySide6.QtWidgets import QFormLayout

from regolith_studio.errors import InputError
from regolith_studio.session.own_presets import OwnPresets
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.parameter_form import ParameterForm
from regolith_studio.ui.widgets.preset_bar import PresetBar, PresetEntry

SHIPPED = "paper"


class PresetForm(ParameterForm):
    """As :class:`ParameterForm`, with a line of presets above; forms of one dataclass share them.

    Parameters
    ----------
    kind
        The dataclass; its defaults are the shipped preset.
    name
        Begins the object names of the editors.
    label
        Of the shipped preset.
    """

    def __init__(self, kind: type[Any], name: str, label: str) -> None:
        self._own = OwnPresets(kind.__name__.lower())
        self._chosen = SHIPPED
        self._known: dict[str, dict[str, Any]] = {SHIPPED: {}}
        self._label = label
        self.bar = PresetBar(f"{name}_preset", tr("Preset of {label}", label=label))
        self.bar.reset.setObjectName(f"{name}_preset_reset")
        super().__init__(kind, name)
        layout = self.layout()
        assert isinstance(layout, QFormLayout), "the form is one"
        layout.insertRow(0, self.bar)
        self.bar.chosen.connect(self._take)
        self.bar.resetRequested.connect(lambda: self._take(self._chosen))
        self.bar.saveRequested.connect(self.save_as)
        self.bar.deleteRequested.connect(self.delete)
        self.valueChanged.connect(self._show_mark)
        self._list()

    def setValue(self, value: Any) -> None:
        """Show these values; announces nothing."""
        super().setValue(value)
        self._show_mark()

    def is_modified(self) -> bool:
        """Whether the values are no longer those of the preset."""
        return self.changes() != self._known[self._chosen]

    def save_as(self, name: str) -> None:
        """Keep the present values as an own preset.

        Raises
        ------
        RegolithError
            If the name cannot be taken or the file cannot be written.
        """
        self._own.save(name, self.changes())
        self._list()
        self._chosen = f"own:{name}"
        self._show_mark()

    def delete(self, key: str) -> None:
        """Forget an own preset; the values stay as they are."""
        self._own.remove(key.removeprefix("own:"))
        self._chosen = SHIPPED
        self._list()

    def _list(self) -> None:
        kept = {f"own:{name}": values for name, values in self._own.all().items()}
        self._known = {SHIPPED: {}} | {
            key: dict(values) for key, values in kept.items() if self._fits(values)
        }
        tip = tr("As the paper gives them; a star where it gives none")
        entries = [PresetEntry(SHIPPED, self._label, tip)]
        entries += [
            PresetEntry(key, key.removeprefix("own:"), tr("Own preset"), own=True)
            for key in self._known
            if key != SHIPPED
        ]
        self.bar.set_entries(entries)
        self._show_mark()

    def _fits(self, values: Mapping[str, Any]) -> bool:
        """Whether this version knows and allows every value."""
        try:
            self._kind(**{name: float(value) for name, value in values.items()})
        except (InputError, TypeError, ValueError):
            return False
        return True

    def _take(self, key: str) -> None:
        self._chosen = key
        self.restore(self._known[key])
        self.valueChanged.emit()

    def _show_mark(self) -> None:
        self.bar.show_state(self._chosen, self.is_modified())
