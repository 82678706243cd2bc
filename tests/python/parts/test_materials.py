"""Materials by name: figures within physical bounds, sources, names that are understood."""

import math

import pytest

from codesign.errors import ModelError
from codesign.parts.materials import find_known, known_materials, material_names, named_material

TABLE = known_materials()
DENSITIES = {"metal": (1700.0, 8100.0), "plastic": (900.0, 1500.0)}
MODULI = {"metal": (40.0, 220.0), "plastic": (1.0, 10.0)}


def test_there_are_metals_and_printed_plastics():
    kinds = [material.kind for material in TABLE.values()]
    assert kinds.count("metal") >= 10
    assert kinds.count("plastic") >= 5


@pytest.mark.parametrize("name", TABLE)
def test_figures_are_consistent_and_have_a_source(name):
    m = TABLE[name]
    assert len(m.source) > 10
    assert DENSITIES[m.kind][0] < m.density_kg_m3 < DENSITIES[m.kind][1]
    assert MODULI[m.kind][0] < m.young_modulus_gpa < MODULI[m.kind][1]
    assert 0.25 < m.poisson_ratio < 0.44
    assert (m.fatigue_strength_mpa is None) == (m.fatigue_cycles is None)
    if m.ultimate_strength_mpa is not None:
        assert m.yield_strength_mpa <= m.ultimate_strength_mpa
    if m.fatigue_strength_mpa is not None:
        assert m.fatigue_strength_mpa < m.yield_strength_mpa
    for key, (low, high) in m.ranges.items():
        assert low <= getattr(m, key) <= high, key


def test_specific_stiffness_of_light_metals_and_steel_is_the_same():
    """E/ρ of aluminum, titanium and steel is about 26 MJ/kg, which a slip in a column would break."""
    for name in (
        "7075-t6",
        "6061-t6",
        "2024-t3",
        "ti-6al-4v",
        "s235",
        "316l",
        "4340-180ksi",
        "17-4ph-h900",
        "az31b-h24",
    ):
        m = find_known(name)
        assert math.isclose(m.young_modulus_gpa * 1e3 / m.density_kg_m3, 25.6, rel_tol=0.06), name


def test_names_and_aliases_are_unique_and_mean_one_material():
    assert len(material_names()) == len(TABLE) + sum(len(m.aliases) for m in TABLE.values())
    assert find_known("titanium_ti6al4v") is find_known("ti-6al-4v")
    assert named_material("ti-6al-4v").yield_strength == 880e6
    assert named_material("ti-6al-4v").density == 4430.0


def test_an_unknown_name_is_answered_by_the_nearest():
    with pytest.raises(ModelError, match=r"no material 'ti-6al-4'; did you mean 'ti-6al-4v'\?"):
        named_material("ti-6al-4")
