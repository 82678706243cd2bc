"""Box-constrained QP: the solution against its certificate and an independent solver; refusals."""

import numpy as np
import pytest

from codesign import dynamics as dyn


def problem(rng: np.random.Generator, n: int, condition: float) -> tuple[np.ndarray, ...]:
    q, _ = np.linalg.qr(rng.standard_normal((n, n)))
    half = q * np.sqrt(np.geomspace(1.0, condition, n))
    return half @ half.T, 3.0 * rng.standard_normal(n), -rng.random(n), rng.random(n)


def test_solution_carries_its_certificate() -> None:
    rng = np.random.default_rng(0)
    H, g, lower, upper = problem(rng, 12, 1e3)
    result = dyn.solve_box_qp(H, g, lower, upper)
    assert result.status == dyn.QpStatus.solved and result.kkt_residual < 1e-9 and result.iterations >= 1
    np.testing.assert_allclose(H @ result.x + g, result.multipliers, atol=1e-9)
    assert (result.x >= lower).all() and (result.x <= upper).all()
    assert (result.multipliers[result.x == lower] >= 0.0).all()
    assert (result.multipliers[result.x == upper] <= 0.0).all()
    free = (result.x > lower) & (result.x < upper)
    assert free.any() and not free.all() and (result.multipliers[free] == 0.0).all()


def test_agrees_with_quadprog() -> None:
    import quadprog

    rng = np.random.default_rng(1)
    for n in (1, 2, 5, 27, 60):
        for _ in range(20):
            H, g, lower, upper = problem(rng, n, 1e4)
            bounds = np.hstack([np.eye(n), -np.eye(n)])
            expected = quadprog.solve_qp(H, -g, bounds, np.concatenate([lower, -upper]))[0]
            np.testing.assert_allclose(dyn.solve_box_qp(H, g, lower, upper).x, expected, atol=1e-9)


def test_solver_starts_from_its_last_working_set() -> None:
    rng = np.random.default_rng(2)
    H, g, lower, upper = problem(rng, 27, 1e3)
    solver = dyn.BoxQpSolver(27)
    first = solver.solve(H, g, lower, upper)
    again = solver.solve(H, g, lower, upper)
    assert first.iterations > 1 and again.iterations == 1
    np.testing.assert_array_equal(first.x, again.x)
    solver.reset()
    assert solver.solve(H, g, lower, upper).iterations == first.iterations
    assert solver.size == 27


def test_infinite_and_equal_bounds() -> None:
    H, g = np.diag([2.0, 4.0, 1.0]), np.array([-2.0, -8.0, 5.0])
    result = dyn.solve_box_qp(H, g, np.array([-np.inf, 1.0, 0.5]), np.array([np.inf, np.inf, 0.5]))
    np.testing.assert_allclose(result.x, [1.0, 2.0, 0.5])
    np.testing.assert_allclose(result.multipliers, [0.0, 0.0, 5.5])


def test_indefinite_hessian_is_a_status() -> None:
    result = dyn.solve_box_qp(np.diag([1.0, -1.0]), np.zeros(2), -np.ones(2), np.ones(2))
    assert result.status == dyn.QpStatus.not_positive_definite


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"H": np.eye(3)}, "must be"),
        ({"H": np.array([[1.0, 0.5], [0.0, 1.0]])}, "symmetric"),
        ({"g": np.array([np.nan, 0.0])}, "finite"),
        ({"lower": np.array([2.0, 0.0])}, r"lower\[0\]"),
        ({"upper": np.array([np.nan, 0.0])}, r"lower\[0\]"),
    ],
)
def test_wrong_arguments_are_refused(change: dict[str, np.ndarray], reason: str) -> None:
    arguments = {"H": np.eye(2), "g": np.zeros(2), "lower": -np.ones(2), "upper": np.ones(2)} | change
    with pytest.raises(ValueError, match=reason):
        dyn.solve_box_qp(**arguments)
    with pytest.raises(ValueError, match=reason):
        dyn.BoxQpSolver(2).solve(**arguments)
