"""An exported design: the folder, its files, and what they say about themselves."""
