"""`python -m timemap_cli`, for where the `timemap` command is not on the path."""

from timemap_cli.cli.entry import run

run()
