"""The checked-in stubs describe the compiled module."""

import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[3]


def test_stubs_are_up_to_date():
    command = (sys.executable, str(REPOSITORY / "scripts" / "make_stubs.py"), "--check")
    result = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
