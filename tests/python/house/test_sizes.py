"""No file, function or folder is too large to be read at once."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[3]
FOLDERS = ("benchmarks", "cpp", "docs", "examples", "python", "scripts", "tests")
SOURCES = {".py", ".cpp", ".hpp", ".js", ".css", ".sh"}
FILE_LINES = 400
FUNCTION_LINES = 60
FOLDER_UNITS = 20
WIDE_FOLDERS = {"cpp/dynamics": 30, "tests/cpp/dynamics": 30}  # one subject each, one concept per unit
LISTS = ("cpp/bindings/",)  # its functions name what Python sees, one entry after the other
NO_FUNCTION = re.compile(r"(class|struct|union|enum)\b[^(]*$|[^(]*=\s*\{$")


def hand_written() -> list[Path]:
    """Source files, relative to the repository; generated stubs are .pyi."""
    files = (file for folder in FOLDERS for file in (REPOSITORY / folder).rglob("*"))
    return [file.relative_to(REPOSITORY) for file in files if file.suffix in SOURCES]


def python_functions(text: str) -> Iterator[tuple[str, int]]:
    """Names of functions and how many lines each has."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            assert node.end_lineno is not None
            yield node.name, node.end_lineno - node.lineno + 1


def cpp_functions(text: str) -> Iterator[tuple[str, int]]:
    """First lines of functions in namespaces and how many lines each has, of a text that clang-format has laid out."""
    header, start, inside = "", 0, False
    for number, line in enumerate(text.splitlines()):
        if inside:
            if line.startswith("}"):
                if not NO_FUNCTION.match(header):
                    yield header, number - start + 1
                header, inside = "", False
        elif not line or line.startswith(("#", "//", "}", "namespace")) or line.endswith((";", "}")):
            header = ""
        else:
            if not header:
                header, start = line, number
            inside = line.endswith("{")


def test_functions_are_found():
    text = "namespace a {\n\nclass B {\n  int c;\n};\n\nint f(int a,\n      int b) {\n\n  g();\n}\n}  // namespace a\n"
    assert list(cpp_functions(text)) == [("int f(int a,", 5)]
    assert list(python_functions("class A:\n    def f(self):\n        return 1\n")) == [("f", 2)]


def test_files_are_short():
    lines = {file: len((REPOSITORY / file).read_text(encoding="utf-8").splitlines()) for file in hand_written()}
    assert {str(file): count for file, count in lines.items() if count > FILE_LINES} == {}


def test_functions_are_short():
    found = {".py": python_functions, ".cpp": cpp_functions, ".hpp": cpp_functions}
    long = [
        f"{file}: {name}: {count} lines"
        for file in hand_written()
        if file.suffix in found and not str(file).startswith(LISTS)
        for name, count in found[file.suffix]((REPOSITORY / file).read_text(encoding="utf-8"))
        if count > FUNCTION_LINES
    ]
    assert long == []


def test_folders_are_small():
    units = defaultdict(set)
    for file in hand_written():
        units[file.parent.as_posix()].add(file.stem)
    limits = {folder: WIDE_FOLDERS.get(folder, FOLDER_UNITS) for folder in units}
    assert {folder: len(names) for folder, names in units.items() if len(names) > limits[folder]} == {}
