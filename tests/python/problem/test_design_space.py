import math

import pytest

from codesign.errors import DesignError
from codesign.problem.design_space import DesignSpace, Variable

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
