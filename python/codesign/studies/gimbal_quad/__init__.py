"""A small flying frame with four gimballed jets: the study that `codesign new` starts from."""
