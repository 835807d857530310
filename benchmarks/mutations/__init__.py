"""What a check of a recording against its baseline tells of mistakes, and of noise alone."""
