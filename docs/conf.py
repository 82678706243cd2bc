"""Configuration of the documentation site: `make docs`."""

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "python"))

project = "codesign"
author = "the codesign developers"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build", "site"]
html_theme = "furo"
html_title = "codesign"
html_show_copyright = False
myst_heading_anchors = 4
myst_enable_extensions = ["deflist", "colon_fence"]
suppress_warnings = ["misc.highlighting_failure"]  # sh and toml blocks with an ellipsis
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_member_order = "bysource"
autodoc_inherit_docstrings = False
napoleon_google_docstring = True
napoleon_numpy_docstring = False


def write_command_reference(*_: object) -> None:
    """docs/api/cli.md: every command with its options, from the program itself."""
    import typer
    from typer.cli import get_docs_for_click

    from codesign.cli.main import app as commands

    click_app = typer.main.get_command(commands)
    context = typer.Context(click_app)
    text = get_docs_for_click(obj=click_app, ctx=context, name="codesign", title="Command line")
    (HERE / "api" / "cli.md").write_text(text, encoding="utf-8")


def join_one_line_sections(*event: Any) -> None:
    """`Raises: A (why), …` with further lines indented is one paragraph, not a section with a broken one."""
    lines, inside = event[-1], False
    for k, line in enumerate(lines):
        if re.match(r"(Returns|Raises|Args): \S", line):
            inside = True
        elif inside and line.startswith("  "):
            lines[k] = line.strip()
        else:
            inside = False


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", join_one_line_sections, priority=100)  # before napoleon
    app.connect("builder-inited", write_command_reference)
