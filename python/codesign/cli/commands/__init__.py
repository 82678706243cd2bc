"""The commands, one module per group: parse, call, print; each returns the exit code."""
