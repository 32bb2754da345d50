"""Panels: each shows one thing and, where it can be changed, edits one value.

``FIELDS`` names the choices that a panel edits. ``value()`` is a mapping of these, ``setValue()`` takes
one (other names are ignored) and announces nothing; ``valueChanged`` carries what the user changed and
``editingFinished`` says that a drag or an entry is over. A panel knows neither the session nor another
panel; :mod:`regolith_studio.ui.wiring` connects it.
"""
