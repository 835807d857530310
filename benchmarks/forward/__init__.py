"""What becomes of the scans of a robot that drives forward and looks ahead."""
