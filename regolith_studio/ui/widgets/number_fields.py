"""Fields for numbers that take point and comma as the decimal sign, whatever the language writes."""

import re

from PySide6.QtGui import QValidator
from PySide6.QtWidgets import QDoubleSpinBox, QLineEdit


class DecimalField(QDoubleSpinBox):
    """Edits a number; ``0.5`` and ``0,5`` are a half in every language.

    Qt's own box takes the other sign for that of thousands and drops it, which makes 5 of it.
    """

    def validate(self, text: str, pos: int) -> tuple[QValidator.State, str, int]:
        return super().validate(self._with_own_sign(text), pos)

    def valueFromText(self, text: str) -> float:
        return super().valueFromText(self._with_own_sign(text))

    def _with_own_sign(self, text: str) -> str:
        point = self.locale().decimalPoint()
        return text.replace("," if point == "." else ".", point)


class NumbersLine(QLineEdit):
    """Edits a list of numbers, as ``0.2, 0.4``; shown as ``0,2; 0,4`` where numbers have a decimal comma.

    There a comma with a space behind it separates too, and a list with points is taken as it is.
    """

    def __init__(self, value: str = "") -> None:
        super().__init__()
        self.setValue(value)

    def value(self) -> str:
        """The list with decimal points, and commas between the numbers."""
        text = self.text()
        if self.locale().decimalPoint() == "." or ("." in text and ";" not in text):
            return text.replace(";", ",")
        parts = re.split(r";|,\s", text)
        return ", ".join(part.strip().replace(",", ".") for part in parts)

    def setValue(self, value: str) -> None:
        """Show a list that is written with decimal points, and commas between the numbers."""
        if self.locale().decimalPoint() == ",":
            value = re.sub(r",\s*", "; ", value).replace(".", ",")
        self.setText(value)
