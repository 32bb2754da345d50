"""The window: panels, views and widgets. Nothing is calculated here."""
