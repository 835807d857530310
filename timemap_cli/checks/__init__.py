"""What a map is expected to be, and whether it still is."""
