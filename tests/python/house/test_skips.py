"""A test that does not run must not look green: all run, but for those whose third-party data is not in a clone."""

import ast
from pathlib import Path

TESTS = Path(__file__).resolve().parents[2]
SKIPS = {"skip", "skipif", "importorskip", "xfail", "SkipTest", "skipTest"}


def skips(file: Path) -> list[str]:
    """Enclosing functions of whatever leaves out a test."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    found = []
    for scope in (tree, *(node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))):
        nodes = [scope, *(n for n in ast.walk(scope) if isinstance(n, ast.Attribute | ast.Name))]
        names = {node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "") for node in nodes}
        if names & SKIPS:
            found.append(getattr(scope, "name", "module"))
    return found


def test_only_absent_shared_data_is_a_reason_to_skip():
    found = {str(file.relative_to(TESTS)): names for file in sorted(TESTS.rglob("*.py")) if (names := skips(file))}
    assert found == {"conftest.py": ["module", "shared_data"]}


def test_a_skip_is_found(tmp_path):
    for text in ("pytest.importorskip('a')", "@pytest.mark.skipif(True)\ndef f():\n    pass", "raise SkipTest"):
        (tmp_path / "a.py").write_text(text)
        assert skips(tmp_path / "a.py")
