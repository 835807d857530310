"""What the guard sets aside: scans of robots that are lost, and those of robots that are not."""
