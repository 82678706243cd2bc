"""What search, store and chain agree on: design space, evaluations, ranking."""
