"""Every class and function that a C++ header declares has a comment: what it is, units, frames, what it throws."""

import re
from pathlib import Path

CPP = Path(__file__).resolve().parents[3] / "cpp"
ANNOUNCED = re.compile(r"(class|struct) \w+;")  # and defined elsewhere
NO_DECLARATION = ("#", "namespace", "}", "template", "using", "inline constexpr", "constexpr", " ", "//")


def without_comment(text: str) -> list[str]:
    """First lines of declarations in namespaces that no comment stands above, in their paragraph, or behind."""
    found, said, inside = [], False, False
    for line in text.splitlines():
        if inside:
            inside = not line.startswith("}")
        elif not line:
            said = False
        elif line.startswith("//"):
            said = True
        elif not line.startswith(NO_DECLARATION) and not ANNOUNCED.match(line):
            if not said and "//" not in line:
                found.append(line)
            inside = line.endswith("{")
    return found


def test_declarations_without_a_comment_are_found():
    text = "// Said.\nint f(int a,\n      int b);\nint g();\n\nint h();\n\nstruct A {\n  int b;\n};\n\nint k();  // m\n"
    assert without_comment(text) == ["int h();", "struct A {"]


def test_headers_explain_what_they_declare():
    headers = [file for file in sorted(CPP.rglob("*.hpp")) if "bindings" not in file.parts]
    assert len(headers) > 80
    found = {str(file.relative_to(CPP)): without_comment(file.read_text(encoding="utf-8")) for file in headers}
    assert {file: lines for file, lines in found.items() if lines} == {}
