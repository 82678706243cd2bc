import math
from decimal import Decimal

import pytest

from codesign.errors import DesignError
from codesign.problem.design_space import DesignSpace, Variable, value_text

SPACE = DesignSpace((Variable("angle", 1, 79, 1, "deg"), Variable("distance", 40, 100, 2, "mm")))


def test_levels_count_both_ends():
    assert SPACE.levels == (79, 31)


@pytest.mark.parametrize("indices", [(0, 0), (78, 30), (14, 1)])
def test_indices_and_design_are_inverse(indices):
    assert SPACE.indices(SPACE.from_indices(indices)) == indices


def test_mapping_and_sequence_give_the_same_design():
    assert SPACE.design({"distance": 42, "angle": 15}) == SPACE.design([15, 42])


@pytest.mark.parametrize(
    ("theta", "message"),
    [
        ({"angle": 15, "distance": 41}, "off the grid.*nearest values 40 and 42"),
        ({"angle": 80, "distance": 42}, "outside 1 … 79"),
        ({"angle": 15}, "no value for design variable 'distance'"),
        ({"angle": 15, "distance": 42, "lenght": 3}, "unknown design variable 'lenght'"),
        ([15], "1 values for 2 variables"),
        ([math.nan, 42], "not a finite number"),
        (["a", 42], "must be numbers"),
    ],
)
def test_bad_designs_are_refused_not_rounded(theta, message):
    with pytest.raises(DesignError, match=message):
        SPACE.design(theta)


def test_whole_numbers_print_as_integers():
    assert SPACE.design([15, 42]).to_dict() == {"angle": 15, "distance": 42}


@pytest.mark.parametrize(
    ("minimum", "step", "levels"), [(0.1, 0.1, 60), (-0.3, 0.05, 40), (1e-3, 1e-4, 30), (2, 0.25, 9)]
)
def test_grid_values_are_the_decimals_that_people_write(minimum, step, levels):
    maximum = float(Decimal(str(minimum)) + (levels - 1) * Decimal(str(step)))
    variable = Variable("x", minimum, maximum, step)
    decimals = -Decimal(str(step)).as_tuple().exponent
    for index in range(levels):
        value = variable.value(index)
        assert value == float(f"{Decimal(str(minimum)) + index * Decimal(str(step)):.{decimals}f}")
        assert variable.index(float(value_text(value))) == index
        assert len(value_text(value).partition(".")[2]) <= decimals
    assert str(DesignSpace((variable,)).from_indices([0])) == f"x={value_text(minimum)}"
    assert Variable("x", 0.1, 2.5, 0.1).every(3).value(4) == 1.3


def test_values_are_shown_exactly():
    assert [value_text(x) for x in (30.0, 1.2, 120.0625, 1234.5678, -0.5)] == [
        "30",
        "1.2",
        "120.0625",
        "1234.5678",
        "-0.5",
    ]


LISTED = DesignSpace(
    (
        Variable.listed("wall", (1.0, 1.5, 3.0), "mm"),
        Variable.listed("alloy", ("ergal", "ti-6al-4v", "7068")),
        Variable("x", 0, 1, 1),
    )
)


def test_listed_values_lie_on_the_integer_grid():
    assert LISTED.levels == (3, 3, 2)
    for indices in ((0, 0, 0), (1, 2, 1), (2, 1, 0)):
        assert LISTED.indices(LISTED.from_indices(indices)) == indices
    assert LISTED.from_indices((2, 1, 1)).to_dict() == {"wall": 3, "alloy": "ti-6al-4v", "x": 1}
    assert str(LISTED.from_indices((1, 0, 1))) == "wall=1.5, alloy=ergal, x=1"
    assert [str(variable) for variable in LISTED.variables] == ["1, 1.5, 3 mm", "ergal, ti-6al-4v, 7068", "0 … 1 by 1"]


def test_a_name_that_looks_like_a_number_is_found_as_one():
    assert LISTED.indices([1.0, 7068.0, 0]) == (0, 2, 0)


@pytest.mark.parametrize(
    ("theta", "message"),
    [
        ({"wall": 2.0, "alloy": "ergal", "x": 0}, "wall = 2 mm: not in the list 1, 1.5, 3 mm"),
        ({"wall": 1.0, "alloy": "ergl", "x": 0}, r"alloy = ergl: no such choice; did you mean 'ergal'\?"),
        ({"wall": 1.0, "alloy": 3.0, "x": 0}, "alloy = 3: no such choice"),
        ({"wall": "ergal", "alloy": "ergal", "x": 0}, "wall = 'ergal': design values must be numbers"),
    ],
)
def test_what_is_not_listed_is_refused(theta, message):
    with pytest.raises(DesignError, match=message):
        LISTED.design(theta)


def test_every_second_of_a_list():
    assert LISTED.variables[1].every(2).values == ("ergal", "7068")
    assert LISTED.variables[0].every(2).maximum == 3.0


def test_positions_of_names_are_their_places():
    wall, alloy, _ = LISTED.variables
    assert (wall.position(1.5), wall.minimum, wall.maximum) == (1.5, 1.0, 3.0)
    assert (alloy.position("7068"), alloy.minimum, alloy.maximum) == (2.0, 0.0, 2.0)
