"""Writes docs/study.md and docs/numbers.md from the code; `--check`: fails where a page is not current."""

import sys
from pathlib import Path

from codesign.study.number_page import numbers_page
from codesign.study.reference import reference_page

DOCS = Path(__file__).parents[1] / "docs"
PAGES = {DOCS / "study.md": reference_page, DOCS / "numbers.md": numbers_page}

if __name__ == "__main__":
    for page, text in PAGES.items():
        if "--check" not in sys.argv:
            page.write_text(text(), encoding="utf-8")
        elif not page.is_file() or page.read_text(encoding="utf-8") != text():
            sys.exit(f"{page} is not current: python scripts/study_reference.py")
