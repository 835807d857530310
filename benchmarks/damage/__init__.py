"""What becomes of recordings that are damaged at random."""
