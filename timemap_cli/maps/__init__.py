"""What robots' maps and results of other drives have in common: arrays in, arrays out, NumPy and the model alone."""
