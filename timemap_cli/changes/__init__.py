"""Estimates in, differences out: pure NumPy, no files and no clock."""
