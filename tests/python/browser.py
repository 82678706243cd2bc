"""A real headless browser for the tests of pages: pages must be silent and must not talk to anyone."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from playwright.sync_api import sync_playwright

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def open_browser() -> Iterator[Any]:
    """A Chromium driven by playwright; it is in apt-packages-test.txt."""
    executable = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if executable is None:
        pytest.fail("no Chromium on this machine (apt: chromium)")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable, args=FLAGS)
        yield browser
        browser.close()


@contextmanager
def visit(
    browser: Any,
    address: str,
    *,
    width: int = 1280,
    height: int = 800,
    dark: bool = False,
    local: tuple[str, ...] = ("file:",),
) -> Iterator[Any]:
    """Opens a page; afterwards checks that it logged no error and asked nobody else for anything."""
    page = browser.new_page(viewport={"width": width, "height": height}, color_scheme="dark" if dark else "light")
    problems: list[str] = []
    page.on("console", lambda m: problems.append(f"console: {m.text}") if m.type == "error" else None)
    page.on("pageerror", lambda error: problems.append(f"exception: {error}"))
    page.on(
        "request",
        lambda r: None if r.url.startswith((*local, "data:", "blob:")) else problems.append(f"request: {r.url[:120]}"),
    )
    page.set_default_timeout(180_000)  # software rendering on a busy machine is slow
    page.goto(address, wait_until="load")
    yield page
    page.close()
    assert problems == []
