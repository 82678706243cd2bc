"""What an export says about itself: a page for people, a manifest for programs; both with the verdict on the design."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import PurePosixPath
from typing import Any

import msgspec

from codesign import __version__
from codesign.cli.export.formats import LOG, ROBOT, units_of
from codesign.cli.export.order import Order, original_of
from codesign.parts.component import distinct_parts
from codesign.parts.part import MirroredPart, Part
from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation
from codesign.report.data import Limits, PartWords
from codesign.report.objections import COMFORT
from codesign.report.reading import demands
from codesign.report.strength import CaseStrength, case_strengths, frequency_words
from codesign.report.study_words import objective_quantities, part_words
from codesign.report.verdict import Verdict
from codesign.study.config import FemConfig, StudyConfig

STRESS_FILES = (
    "In `stress/*.vtu`, the peak stress is read where `counts_for_peak` is 1; the strings in the field data say what "
    "was analyzed.\n"
)
ROBOT_FILES = (
    (ROBOT, "robot.urdf", "links, joints, masses, meshes"),
    (("mjcf",), "robot.xml", "the same for MuJoCo, with thrusters as actuators and the start as keyframe"),
    (("sdf",), "robot.sdf", "the same for Gazebo and Drake, with thrusters as frames"),
    (("ros2",), "../ros2", "package for ROS 2: `colcon build`, then `ros2 launch PACKAGE display.launch.py`"),
    (ROBOT, "robot.srdf", "start posture, collisions to be left out"),
    ((*ROBOT, *LOG), "robot.json", "thrusters with axes, limits and dynamics, start, controller"),
    (("csv",), "flight.csv", "the flight that the objectives are of"),
    (("parquet",), "flight.parquet", "the same, with units as metadata"),
    (("mcap",), "flight.mcap", "the same as ROS 2 messages"),
)
LICENSE = (
    "The license of codesign covers the program, not what is designed with it: the parts belong to the author of the "
    "study, and so does the choice of their license."
)
OPEN = (
    "threads, surface finish, heat treatment and coating: these files do not state them; tolerances are ISO 2768-mK "
    "where no fit is given"
)
STRENGTH_HEAD = ["part", "load case", "loads", "safety factor", "at least", "peak stress ± its estimated error"]


@dataclass(frozen=True)
class OrderPage:
    """An order with what was computed of its design.

    verdict: whether it may be built. models: of each part, what the VTU files in `stress` hold. confirmed: parts as
    analyzed on finer meshes, if the run of the design has them.
    """

    order: Order
    evaluation: Evaluation
    verdict: Verdict
    models: Mapping[str, str]
    confirmed: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def manifest(self, files: Sequence[str]) -> str:
        """Everything a reader or a program needs to know about the files, as JSON; SI units."""
        order, evaluation = self.order, self.evaluation
        study = order.study
        known = objective_quantities(tuple(evaluation.objectives), study.config)
        document = {
            "codesign": __version__,
            "revision": order.revision,
            "study": {"name": study.name, "title": study.title, "hash": study.hash},
            "chosen": order.chosen,
            "verdict": self.verdict.document(),
            "organization": order.organization,
            "design": order.values,
            "status": evaluation.status,
            "reason": evaluation.reason,
            "objectives": evaluation.objectives,
            "objective_labels": {q.key: {"label": q.label, "shown_in": q.unit} for q in known},
            "constraints": evaluation.constraints,
            "parts": [self._part(part) for part in distinct_parts(order.components)],
            "units": units_of(order.formats, files),
            "not_stated": OPEN,
            "license": LICENSE,
            "files": sorted(files),
        }
        return json.dumps(document, indent=1)

    def text(self, written: Collection[str]) -> str:
        """The same for people, as Markdown. written: files so far, relative to the folder."""
        order, formats = self.order, self.order.formats
        values = [[name, value_text(item["value"]), item["unit"]] for name, item in order.values.items()]
        units = [[f"`{kind}`", unit] for kind, unit in units_of(formats, written).items()]
        return "\n".join(
            [
                *self._head(),
                *_verdict(self.verdict),
                *_table(["design variable", "value", "unit"], values),
                *_table(["part", "quantity", "material", "mass each", "", "files"], self._parts()),
                *(f"**{words.warning}**\n" for words in self._words.values() if words.warning),
                f"`bom.csv` is the second table for programs, `manifest.json` all of this. {self._cad_words()}\n",
                *_robot_words(written),
                *self._reached(),
                "## Strength\n",
                *_table(STRENGTH_HEAD, self._strength()),
                *self._strength_notes(),
                *([STRESS_FILES] if "vtu" in formats else []),
                "## Units\n",
                *_table(["files", "units"], units),
                f"Not stated, to be agreed with the workshop: {OPEN.partition(':')[0]}.\n",
                f"{LICENSE}\n",
            ]
        )

    @cached_property
    def _config(self) -> StudyConfig:
        return self.order.study.configured(self.order.design)

    @cached_property
    def _words(self) -> dict[str, PartWords]:
        return part_words(self._config)

    @cached_property
    def _limits(self) -> Limits:
        return demands(self._config)

    def _head(self) -> list[str]:
        order, study = self.order, self.order.study
        return [
            f"# {study.title}: parts to be made\n",
            f"Revision {order.revision}, study `{study.name}` {study.hash}, codesign {__version__}"
            + (f"; {order.chosen}" if order.chosen else "")
            + (f"; {order.organization}" if order.organization else "")
            + ".\n",
        ]

    def _parts(self) -> list[list[Any]]:
        rows = []
        for part in distinct_parts(self.order.components):
            mirror = f"mirror image of {original_of(part).name}" if isinstance(part, MirroredPart) else ""
            mass = f"{part.mass_properties().mass:.4g} kg"
            paths = (self.order.file_of(part, kind) for kind in ("pdf", "step", "stl"))
            material = f"{self.order.config_of(part).material}, {part.density:g} kg/m³"
            files = ", ".join(f"`{path}`" for path in paths if path)
            rows.append([part.name, self.order.quantities[part.name], material, mass, mirror, files])
        return rows

    def _cad_words(self) -> str:
        formats, on_robot = self.order.formats, self.order.study.config.robot is not None
        assembly = " and ".join(f"`cad/assembly.{kind}`" for kind in ("step", "glb") if kind in formats)
        beside = "In `cad/parts.3mf` all pieces lie side by side. " if "3mf" in formats else ""
        place = " on the robot" if on_robot else ""
        return beside + (f"In {assembly} they are in their places{place}." if assembly else "")

    def _reached(self) -> list[str]:
        """The objectives by their names."""
        values = self.evaluation.objectives
        known = objective_quantities(tuple(values), self.order.study.config)
        if not known:
            return []
        rows = [[q.label, f"{q.shown(values[q.key]):.4g}", q.unit] for q in known]
        return ["## What the design was chosen for\n", *_table(["number", "value", "unit"], rows)]

    def _strength(self) -> list[list[Any]]:
        """A row for every load case of every part; a second one where the case was confirmed."""
        rows = []
        for name, part in self.evaluation.parts.items():
            for case in self._cases(name, part):
                rows.append(self._case_row(name, case, ""))
                better = [c for c in self._cases(name, self.confirmed.get(name, {})) if c.name == case.name]
                rows += [self._case_row(name, each, ", on a finer mesh") for each in better]
        return rows

    def _cases(self, name: str, part: Mapping[str, Any]) -> list[CaseStrength]:
        return case_strengths(name, part, self._limits) if part else []

    def _case_row(self, name: str, case: CaseStrength, how: str) -> list[Any]:
        factor = "not stressed" if case.factor is None else f"{case.factor:.3g}"
        decides = f"**{case.name}**, decides" if case.decides else case.name
        return [
            name,
            decides + how,
            self._words[name].cases.get(case.name, ""),
            f"**{factor}**" if case.decides else factor,
            "" if case.least is None else f"{case.least:g}",
            case.stress,
        ]

    def _strength_notes(self) -> list[str]:
        """How each part is held, its first natural frequency, and what to know of the place that decides."""
        lines = []
        for name, part in self.evaluation.parts.items():
            words = self._words[name]
            model = f"; analyzed: {self.models[name]}" if name in self.models else ""
            lines.append(f"- {name}: {words.held}{model}." + (f" It carries {words.carried}." if words.carried else ""))
            frequency = frequency_words(name, part, self._limits, words.carried)
            place = next((case.place for case in self._cases(name, part) if case.decides), "")
            lines += [f"- {text[:1].upper()}{text[1:]}." for text in (frequency, place) if text]
        tolerance = f"{100 * self.order.study.config.fem.tolerance:g}\u202f%"
        lines.append(
            f"- Errors are estimates; {tolerance} is asked for. A safety factor that keeps its limit even less "
            f"{COMFORT:g} times its error counts as settled."
        )
        return [*lines, ""] if self.evaluation.parts else []

    def _part(self, part: Part) -> dict[str, Any]:
        config = self._config
        settings, original = self.order.config_of(part), original_of(part)
        numbers = self.evaluation.parts.get(original.name, {})
        confirmed = self.confirmed.get(original.name, {})
        keys = ("safety_factor", "peak_stress", "stress_error", "max_displacement", "first_frequency")
        return {
            "name": part.name,
            "quantity": self.order.quantities[part.name],
            "mirror_image_of": original.name if isinstance(part, MirroredPart) else None,
            "parameters": part.parameters,
            "material": {"name": settings.material, **msgspec.to_builtins(config.materials[settings.material])},
            "density_kg_m3": part.density,
            "mass": part.mass_properties().mass,
            "load_case": {
                "supports": msgspec.to_builtins(settings.supports),
                "held": self._words[original.name].held,
                "masses": msgspec.to_builtins(settings.masses),
                "cases": msgspec.to_builtins(settings.load_cases),
                "settings": _settings(config.fem),
                "model": self.models.get(original.name),
            },
            "strength": {key: numbers.get(key) for key in keys}
            | {"cases": [case.document() for case in self._cases(original.name, numbers)]}
            | {"confirmed_cases": [case.document() for case in self._cases(original.name, confirmed)]},
        }


def _settings(fem: FemConfig) -> dict[str, Any]:
    """Settings of the stress analysis; a part's own variants of load and support only where they are not the usual."""
    usual, settings = FemConfig(), msgspec.to_builtins(fem)
    return {
        key: value for key, value in settings.items() if key not in ("load", "support") or value != getattr(usual, key)
    }


def _verdict(verdict: Verdict) -> list[str]:
    """The verdict as Markdown."""
    if verdict.kind == "build":
        lines = [f"**{verdict.title}**: nothing that this study checks speaks against it."]
    else:
        lines = [f"**{verdict.title}. {verdict.head}:**", "", *(f"- {reason}" for reason in verdict.reasons)]
    remedies = [f"What to do: {text}" for text in verdict.remedies]
    return [*lines, "", *(f"{text}\n" for text in (*remedies, *verdict.notes))]


def _robot_words(files: Collection[str]) -> list[str]:
    """What the files of the robot hold; nothing of a study of parts alone, which writes none."""
    folders = {PurePosixPath(file).parts[0] for file in files}
    lines = [
        f"- `robot/{file}`: {words}"
        for _, file, words in ROBOT_FILES
        if f"robot/{file}" in files or (file == "../ros2" and "ros2" in folders)
    ]
    return ["## Robot\n", *lines, ""] if lines else []


def _table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> list[str]:
    """A Markdown table and an empty line."""
    lines = [head, ["---"] * len(head), *rows]
    return [*("| " + " | ".join(str(cell).replace("|", "/") for cell in line) + " |" for line in lines), ""]
