"""The MCAP result: writing it and reading it back."""
