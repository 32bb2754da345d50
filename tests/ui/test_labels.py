"""Labels that show all that they say."""

from PySide6.QtWidgets import QVBoxLayout, QWidget

from regolith_studio.ui.widgets.labels import WholeLabel

WORDS = "In each step one plane is moved at random, and the move is taken or not. " * 3


def test_that_a_whole_label_has_all_its_lines_where_there_is_no_room_for_them(app):
    label, below = WholeLabel(WORDS), QWidget()
    below.setMinimumHeight(40)
    around = QWidget()
    column = QVBoxLayout(around)
    column.addWidget(label)
    column.addWidget(below)
    around.resize(240, 60)
    around.show()
    app.processEvents()
    assert label.height() >= label.heightForWidth(label.width()) > 4 * label.fontMetrics().height()
    label.setText(3 * WORDS)
    app.processEvents()
    assert label.height() >= label.heightForWidth(label.width()) > 12 * label.fontMetrics().height()
    around.deleteLater()
