"""AGE-MOEA and AGE-MOEA-II, which pymoo compiles with numba."""

import pytest

from evolution_checks import WITH_NUMBA, check_evolution


@pytest.mark.parametrize("algorithm", sorted(WITH_NUMBA))
@pytest.mark.parametrize("batch", [12, 1])
def test_evolution_is_deterministic_and_never_asks_twice(algorithm: str, batch: int) -> None:
    check_evolution(algorithm, batch)
