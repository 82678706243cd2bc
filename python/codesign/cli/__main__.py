"""`python -m codesign.cli`."""

from codesign.cli.main import main

main()
