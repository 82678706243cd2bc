"""An exported design as an order: how many of what, of which material, under which revision; bill of materials."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from codesign.cli.export.formats import DEFAULT
from codesign.errors import LibraryError
from codesign.parts.component import Component, distinct_parts
from codesign.parts.part import MirroredPart, Part
from codesign.problem.design_space import Design, value_text

if TYPE_CHECKING:
    from codesign.chain.study import Study
    from codesign.parts.drawing import Caption


@dataclass(frozen=True)
class Order:
    """A design to be made: the study and its values, where they come from, who makes it, and what was computed.

    chosen: how the design was found, "design 14 of runs/a"; "" if its values were given. components: parts in their
    places, one for each piece to be made. formats: of the files beside these.
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
                self.config_of(part).material,
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
            "mirror_image_of": original_of(part).name if isinstance(part, MirroredPart) else "",
            "material": self.config_of(part).material,
            "density_kg_m3": f"{part.density:.10g}",
            "mass_each_kg": f"{mass:.6g}",
            "mass_total_kg": f"{count * mass:.6g}",
            "step": self.file_of(part, "step"),
            "stl": self.file_of(part, "stl"),
            "drawing": self.file_of(part, "pdf"),
            "revision": self.revision,
        }

    def file_of(self, part: Part, kind: str) -> str:
        """Path of a part's file; "" if it is not written."""
        return f"cad/{part.name}.{kind}" if kind in self.formats else ""

    def config_of(self, part: Part) -> Any:
        """The study's section on a part."""
        name = original_of(part).name
        return next(section for section in self.study.configured(self.design).parts if section.name == name)


def original_of(part: Part) -> Part:
    """The part that a mirror image is of; any other part itself."""
    return part.original if isinstance(part, MirroredPart) else part
