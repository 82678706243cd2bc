"""Nothing of a study is read by nobody: a key that is accepted decides something."""

import ast
from pathlib import Path
from typing import Any

import msgspec
import msgspec.inspect as kinds
import pytest

import codesign
from codesign.search.optimization import optimize
from codesign.study.config import ExecutionConfig, OptimizerConfig, StudyConfig
from fake_study import FakeStudy, study

PACKAGE = Path(codesign.__file__).parent
JUDGES = "checking"  # its files look at values, but do nothing with them


class Spied:
    """A section of a study that notes which of its keys are asked for."""

    def __init__(self, section: Any) -> None:
        self._section, self.asked = section, set[str]()

    def __getattr__(self, name: str) -> Any:
        self.asked.add(name)
        return getattr(self._section, name)


def structs(kind: kinds.Type) -> list[kinds.StructType]:
    """All tables of a configuration."""
    if isinstance(kind, kinds.StructType):
        return [kind, *(found for field in kind.fields for found in structs(field.type))]
    if isinstance(kind, kinds.UnionType):
        return [found for other in kind.types for found in structs(other)]
    if isinstance(kind, kinds.DictType):
        return structs(kind.value_type)
    if isinstance(kind, kinds.CollectionType):
        return structs(kind.item_type)
    return []


def names_used() -> set[str]:
    """Attributes that the package reads, and names that it gives to getattr by a table of texts."""
    used = set()
    for file in PACKAGE.rglob("*.py"):
        if file.parent.name == JUDGES:
            continue
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load):
                used.add(node.attr)
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                used.add(node.value)
    return used


def test_every_key_of_the_configuration_is_read_somewhere():
    used = names_used()
    tables = structs(kinds.type_info(StudyConfig))
    assert len(tables) > 20
    unread = {
        f"{table.cls.__name__}.{field.encode_name}"
        for table in tables
        for field in table.fields
        if field.name not in used
    }
    assert not unread


@pytest.mark.parametrize(("section", "config"), [("optimizer", OptimizerConfig()), ("execution", ExecutionConfig())])
def test_a_search_reads_every_default_that_a_study_gives(tmp_path, section, config):
    spy = Spied(
        msgspec.structs.replace(config, **({"population": 4, "generations": 1} if section == "optimizer" else {}))
    )
    own: FakeStudy = study()
    setattr(own, section, spy)
    optimize(own, out=tmp_path / "run", cache=None, evaluations=None if section == "optimizer" else 4)
    assert spy.asked == set(config.__struct_fields__)
