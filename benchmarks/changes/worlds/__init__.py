"""Simulated worlds whose changes are known, and the drives through them."""
