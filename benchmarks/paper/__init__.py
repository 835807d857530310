"""The paper, executable: its figures and its table as experiments on simulated scans."""
