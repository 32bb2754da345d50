"""Panels: each shows one thing and, where it can be changed, edits one value.

``FIELDS`` names the choices that a panel edits. ``value()`` is a mapping of these, ``setValue()`` takes
one (other names are ignored) without emitting a signal; ``valueChanged`` carries what the user changed and
``editingFinished`` follows the end of a drag or an entry. A panel knows neither the session nor another
panel; :mod:`regolith_studio.ui.bindings` connects it.
"""
