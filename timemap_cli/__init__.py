"""Replay laser scans through a map that remembers at several time scales."""

__version__ = "0.1.0"
