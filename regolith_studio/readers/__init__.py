"""Readers of untrusted files: parsed in a sandbox process, refused with one sentence."""
