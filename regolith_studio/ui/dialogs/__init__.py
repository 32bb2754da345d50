"""Dialogs: questions that the window asks before it does something."""
