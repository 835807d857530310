"""The command line: options in, one call, one text out. Nothing is computed here."""
