"""What all sections of a study.toml share: their base and the types of their values."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

Positive = Annotated[float, Meta(gt=0)]
NonNegative = Annotated[float, Meta(ge=0)]
Probability = Annotated[float, Meta(ge=0, le=1)]
Name = Annotated[str, Meta(min_length=1)]
ChoiceName = Annotated[str, Meta(pattern=r"^\w[\w.+-]*$")]  # is written in --set and in names of files
Deviation = Annotated[float, Meta(ge=0, le=0.15)]  # relative; random numbers stay within six deviations
Seed = Annotated[int, Meta(ge=0, le=2**32 - 1)]
Sign = Annotated[float, Meta(ge=-1, le=1)]
Vector3 = tuple[float, float, float]
Range = tuple[float, float]


class Section(Struct, frozen=True, forbid_unknown_fields=True):
    """Base of all sections: immutable, unknown keys are errors."""
