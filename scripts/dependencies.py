"""Prints the packages that pyproject.toml asks for, one per line, with those of the extras named as arguments."""

import sys
import tomllib
from pathlib import Path


def main() -> None:
    """Prints the list."""
    file = Path(__file__).resolve().parents[1] / "pyproject.toml"
    document = tomllib.loads(file.read_text(encoding="utf-8"))
    project = document["project"]
    extras = (requirement for extra in sys.argv[1:] for requirement in project["optional-dependencies"][extra])
    print(*document["build-system"]["requires"], *project["dependencies"], *extras, sep="\n")


if __name__ == "__main__":
    main()
