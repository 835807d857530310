"""Recordings in, laser scans with poses out: the only room that reads bags."""
