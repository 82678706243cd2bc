"""Writes docs/study.md from the configuration's classes; `--check`: fails where the page is not current."""

import sys
from pathlib import Path

from codesign.study.reference import reference_page

PAGE = Path(__file__).parents[1] / "docs" / "study.md"

if __name__ == "__main__":
    if "--check" in sys.argv:
        current = PAGE.read_text(encoding="utf-8") == reference_page()
        sys.exit(0 if current else f"{PAGE} is not current: python scripts/study_reference.py")
    PAGE.write_text(reference_page(), encoding="utf-8")
