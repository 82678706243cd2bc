"""What is wrong with a study: every check yields pairs (key, reason)."""
