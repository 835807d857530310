"""The method: scans to virtual scans, memory at several levels, estimates. NumPy alone, no files."""
