"""Shared fixtures."""

import os
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """The cache of all tests, also of the programs that they start: never the user's."""
    os.environ["CODESIGN_CACHE"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of third-party reference data, kept beside the repository; not part of the product."""
    shared = Path(os.environ.get("CODESIGN_SHARED", REPOSITORY.parent / "shared"))
    if not (shared / "data").is_dir():
        pytest.skip("third-party reference data (../shared/data or $CODESIGN_SHARED) is not on this machine")
    return shared / "data"
