"""What an export says about itself, so that it can be ordered: manifest, bill of materials, a page to read."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

import msgspec

from codesign import __version__
from codesign.cli.export_formats import DEFAULT, LOG, ROBOT, units_of
from codesign.errors import LibraryError
from codesign.parts.component import Component, distinct_parts
from codesign.parts.part import MirroredPart, Part
from codesign.problem.design_space import Design, value_text
from codesign.problem.evaluation import Evaluation
from codesign.report.objections import objections
from codesign.report.study_words import part_words
from codesign.units import MEGA

if TYPE_CHECKING:
    from codesign.chain.study import Study
    from codesign.parts.drawing import Caption

STRESS_FILES = (
    "In `stress/*.vtu`, the peak stress is read where `counts_for_peak` is 1; the strings in the field data say what "
    "was analyzed.\n"
)
ROBOT_FILES = (
    (ROBOT, "robot.urdf", "links, joints, masses, meshes"),
    (("mjcf",), "robot.xml", "the same for MuJoCo, with jets as actuators and the start as keyframe"),
    (("sdf",), "robot.sdf", "the same for Gazebo and Drake, with jets as frames"),
    (("ros2",), "../ros2", "package for ROS 2: `colcon build`, then `ros2 launch PACKAGE display.launch.py`"),
    (ROBOT, "robot.srdf", "start posture, collisions to be left out"),
    ((*ROBOT, *LOG), "robot.json", "jets with axes, limits and dynamics, start, controller"),
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


@dataclass(frozen=True)
class Order:
    """A design to be made: the study and its values, where they come from, who makes it, and what was computed.

    chosen: how the design was found, "design 14 of runs/a"; "" if its values were given. components: parts in their
    places, one for each piece to be made. formats: of the files beside these. models: of each part, what the VTU files
    in `stress` hold.
    """

    study: Study
    design: Design
    components: Sequence[Component]
    chosen: str = ""
    organization: str = ""
    formats: Sequence[str] = DEFAULT

    @property
    def revision(self) -> str:
        """Hash of all that decides the exported numbers and shapes."""
        content = json.dumps([self.study.hash, self.design.to_dict()], sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()[:12]

    @property
    def quantities(self) -> Counter[str]:
        """How many of each part the design needs, by name."""
        return Counter(component.part.name for component in self.components)

    @property
    def values(self) -> dict[str, dict[str, Any]]:
        """Design values with their units."""
        units = {variable.name: variable.unit for variable in self.study.space.variables}
        return {name: {"value": value, "unit": units[name]} for name, value in self.design.items()}

    def captions(self) -> dict[str, Caption]:
        """What the drawing of each part says beside its geometry. Raises: LibraryError: no OpenCASCADE."""
        try:
            from codesign.parts.drawing import Caption
        except ImportError as error:
            raise LibraryError.of(error, "a drawing") from error

        units = self.values
        design = ", ".join(f"{name} = {value_text(value)} {units[name]['unit']}" for name, value in self.design.items())
        return {
            part.name: Caption(
                part.name,
                part.title,
                self._config(part).material,
                part.mass_properties().mass,
                part.density,
                self.quantities[part.name],
                design,
                self.revision,
                f"{part.name}.step",
                self.organization or self.study.title,
                tuple(part.fits().items()),
                tuple(part.positions().items()),
            )
            for part in distinct_parts(self.components)
        }

    def manifest(self, evaluation: Evaluation, models: Mapping[str, str], files: Sequence[str]) -> str:
        """Everything a reader or a program needs to know about the files, as JSON; SI units."""
        document = {
            "codesign": __version__,
            "revision": self.revision,
            "study": {"name": self.study.name, "title": self.study.title, "hash": self.study.hash},
            "chosen": self.chosen,
            "organization": self.organization,
            "design": self.values,
            "status": evaluation.status,
            "reason": evaluation.reason,
            "objectives": evaluation.objectives,
            "constraints": evaluation.constraints,
            "parts": [self._part(part, evaluation, models) for part in distinct_parts(self.components)],
            "units": units_of(self.formats, files),
            "not_stated": OPEN,
            "license": LICENSE,
            "files": sorted(files),
        }
        return json.dumps(document, indent=1)

    def bill_of_materials(self) -> str:
        """CSV with one line per part: quantity, material, masses [kg], files."""
        rows = [self._item(item, part) for item, part in enumerate(distinct_parts(self.components), start=1)]
        table = io.StringIO()
        writer = csv.DictWriter(table, rows[0] if rows else ["item"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return table.getvalue()

    def _item(self, item: int, part: Part) -> dict[str, Any]:
        count, mass = self.quantities[part.name], part.mass_properties().mass
        return {
            "item": item,
            "part": part.name,
            "quantity": count,
            "mirror_image_of": _original(part).name if isinstance(part, MirroredPart) else "",
            "material": self._config(part).material,
            "density_kg_m3": f"{part.density:.10g}",
            "mass_each_kg": f"{mass:.6g}",
            "mass_total_kg": f"{count * mass:.6g}",
            "step": self._file(part, "step"),
            "stl": self._file(part, "stl"),
            "drawing": self._file(part, "pdf"),
            "revision": self.revision,
        }

    def page(self, evaluation: Evaluation, models: Mapping[str, str], written: Collection[str]) -> str:
        """The same for people, as Markdown. written: files so far, relative to the folder."""
        study = self.study
        head = [
            f"# {study.title}: parts to be made\n",
            f"Revision {self.revision}, study `{study.name}` {study.hash}, codesign {__version__}"
            + (f"; {self.chosen}" if self.chosen else "")
            + (f"; {self.organization}" if self.organization else "")
            + ".\n",
        ]
        if evaluation.status != "feasible":
            head.append(f"**This design is {evaluation.status}: {evaluation.reason}**\n")
        else:
            against = [objection.text for objection in objections(evaluation, {}) if objection.final]
            head += [f"**Not to be built: {text}.**\n" for text in against]
        values = [[name, value_text(item["value"]), item["unit"]] for name, item in self.values.items()]
        parts = []
        for part in distinct_parts(self.components):
            mirror = f"mirror image of {_original(part).name}" if isinstance(part, MirroredPart) else ""
            mass = f"{part.mass_properties().mass:.4g} kg"
            files = ", ".join(f"`{file}`" for kind in ("pdf", "step", "stl") if (file := self._file(part, kind)))
            parts.append(
                [part.name, self.quantities[part.name], self._material_words(part), mass, mirror, files],
            )
        return "\n".join(
            [
                *head,
                *_table(["design variable", "value", "unit"], values),
                *_table(["part", "quantity", "material", "mass each", "", "files"], parts),
                *(
                    f"**{words.warning}**\n"
                    for words in part_words(study.configured(self.design)).values()
                    if words.warning
                ),
                f"`bom.csv` is the second table for programs, `manifest.json` all of this. {self._cad_words()}\n",
                *_robot_words(written),
                "## Strength\n",
                *_table(
                    ["part", "load case", "model", "safety factor", "peak stress"], self._strength(evaluation, models)
                ),
                *([STRESS_FILES] if "vtu" in self.formats else []),
                "## Units\n",
                *_table(
                    ["files", "units"], [[f"`{kind}`", unit] for kind, unit in units_of(self.formats, written).items()]
                ),
                f"Not stated, to be agreed with the workshop: {OPEN.partition(':')[0]}.\n",
                f"{LICENSE}\n",
            ]
        )

    def _file(self, part: Part, kind: str) -> str:
        """Path of a part's file; "" if it is not written."""
        return f"cad/{part.name}.{kind}" if kind in self.formats else ""

    @property
    def _on_robot(self) -> str:
        return " on the robot" if self.study.config.robot is not None else ""

    def _cad_words(self) -> str:
        assembly = " and ".join(f"`cad/assembly.{kind}`" for kind in ("step", "glb") if kind in self.formats)
        beside = "In `cad/parts.3mf` all pieces lie side by side. " if "3mf" in self.formats else ""
        return beside + (f"In {assembly} they are in their places{self._on_robot}." if assembly else "")

    def _strength(self, evaluation: Evaluation, models: Mapping[str, str]) -> list[list[Any]]:
        words = part_words(self.study.configured(self.design))
        rows = []
        for name, numbers in evaluation.parts.items():
            peak, error = numbers["peak_stress"] / MEGA, numbers["stress_error"] / MEGA
            factor = numbers["safety_factor"]
            shown = "-" if factor is None else f"{factor:.3g}"
            rows.append([name, words[name].load, models.get(name, ""), shown, f"{peak:.3g} ± {error:.2g} MPa"])
        return rows

    def _part(self, part: Part, evaluation: Evaluation, models: Mapping[str, str]) -> dict[str, Any]:
        config = self.study.configured(self.design)
        settings, original = self._config(part), _original(part)
        numbers = evaluation.parts.get(original.name, {})
        return {
            "name": part.name,
            "quantity": self.quantities[part.name],
            "mirror_image_of": original.name if isinstance(part, MirroredPart) else None,
            "parameters": part.parameters,
            "material": {"name": settings.material, **msgspec.to_builtins(config.materials[settings.material])},
            "density_kg_m3": part.density,
            "mass": part.mass_properties().mass,
            "load_case": {
                "supports": msgspec.to_builtins(settings.supports),
                "cases": msgspec.to_builtins(settings.load_cases),
                "settings": msgspec.to_builtins(config.fem),
                "model": models.get(original.name),
            },
            "strength": {
                key: numbers.get(key) for key in ("safety_factor", "peak_stress", "stress_error", "max_displacement")
            },
        }

    def _config(self, part: Part) -> Any:
        """The study's section on a part."""
        name = _original(part).name
        return next(section for section in self.study.configured(self.design).parts if section.name == name)

    def _material_words(self, part: Part) -> str:
        return f"{self._config(part).material}, {part.density:g} kg/m³"


def _robot_words(files: Collection[str]) -> list[str]:
    """What the files of the robot hold; nothing of a study of parts alone, which writes none."""
    folders = {PurePosixPath(file).parts[0] for file in files}
    lines = [
        f"- `robot/{file}`: {words}"
        for _, file, words in ROBOT_FILES
        if f"robot/{file}" in files or (file == "../ros2" and "ros2" in folders)
    ]
    return ["## Robot\n", *lines, ""] if lines else []


def _original(part: Part) -> Part:
    return part.original if isinstance(part, MirroredPart) else part


def _table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> list[str]:
    """A Markdown table and an empty line."""
    lines = [head, ["---"] * len(head), *rows]
    return [*("| " + " | ".join(str(cell).replace("|", "/") for cell in line) + " |" for line in lines), ""]
