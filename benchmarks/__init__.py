"""Measurements side by side; nothing here is part of the package."""
