"""The sandbox process that parses untrusted files: its parent, its child and what runs in it."""
