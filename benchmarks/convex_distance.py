"""Distances of convex hulls: ours and coal's on the pairs that a study's clearances ask for; table of a decision.

    python benchmarks/convex_distance.py [--repeats 5]

Needs coal (PyPI, the collision library of Pinocchio). Accuracy: against the exact distance of the origin to the hull of
all differences of points, for up to 1000 pairs. As hardly a pair of a sound design overlaps, the same hulls are also
moved into one another. Time: CPU, least of the repeats; coal's calls from Python are reduced by the time of as many
calls for two spheres.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import coal
import numpy as np
import trimesh
from scipy.spatial import ConvexHull

import codesign
from codesign.dynamics import hull_distances, nearest_approaches
from codesign.robot import clearance
from codesign.transforms import inverse

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
Pair = tuple[np.ndarray, np.ndarray, np.ndarray]  # points, points, first_T_second


def asked_pairs() -> list[Pair]:
    """Pieces of all pairs of links that one evaluation of the shipped study measures, in its first and last posture."""
    pairs: list[Pair] = []

    def record(bodies: Sequence[Sequence[np.ndarray]], poses: np.ndarray, numbers: np.ndarray, limit: float) -> Any:
        for (a, b), k in product(numbers, (0, -1)):
            pose = inverse(poses[a, k]) @ poses[b, k]
            pairs.extend((first, second, pose) for first, second in product(bodies[a], bodies[b]))
        return nearest_approaches(bodies, poses, numbers, limit)

    clearance.nearest_approaches = record
    codesign.load_study("ironcub_paper").evaluate(DESIGN)
    clearance.nearest_approaches = nearest_approaches
    return pairs


def moved_together(pair: Pair) -> Pair:
    """The pair with its centers at 0 to 0.3 of their distance."""
    first, second, pose = pair
    apart = pose[:3, :3] @ second.mean(axis=0) + pose[:3, 3] - first.mean(axis=0)
    moved = pose.copy()
    moved[:3, 3] -= (0.7 + 0.3 * abs(np.sin(1e3 * pose[0, 3]))) * apart
    return first, second, moved


def exact(pair: Pair) -> float:
    """Signed distance from the hull of all differences; NaN where it is flat."""
    first, second, pose = pair
    moved = second @ pose[:3, :3].T + pose[:3, 3]
    points = (first[:, None] - moved[None]).reshape(-1, 3)
    try:
        hull = ConvexHull(points)
    except Exception:
        return np.nan
    triangles = points[hull.simplices]
    nearest = trimesh.triangles.closest_point(triangles, np.zeros((len(triangles), 3)))
    distance = float(np.linalg.norm(nearest, axis=1).min())
    return -distance if (hull.equations[:, 3] < 0).all() else distance


def ours(pairs: Sequence[Pair]) -> np.ndarray:
    """One native call for all pairs."""
    hulls = list({id(points): points for pair in pairs for points in pair[:2]}.values())
    number = {id(points): k for k, points in enumerate(hulls)}
    first, second = (np.array([number[id(pair[k])] for pair in pairs]) for k in (0, 1))
    return hull_distances(hulls, first, second, np.array([pair[2] for pair in pairs]))


class Coal:
    """The same pairs as coal's shapes; its defaults, or tolerances of 1e-10."""

    def __init__(self, pairs: Sequence[Pair], tolerance: float | None) -> None:
        shapes: dict[int, Any] = {}
        self.calls = []
        for *hulls, pose in pairs:
            for points in hulls:
                if id(points) not in shapes:
                    vector = coal.StdVec_Vec3s()
                    vector.extend(list(points))
                    shapes[id(points)] = coal.Convex.convexHull(vector, False, "")
            transform = coal.Transform3s(pose[:3, :3], pose[:3, 3])
            self.calls.append((shapes[id(hulls[0])], shapes[id(hulls[1])], transform))
        self.identity, self.request = coal.Transform3s(), coal.DistanceRequest()
        self.request.enable_signed_distance = True
        if tolerance is not None:
            self.request.gjk_tolerance = self.request.epa_tolerance = tolerance

    def distances(self) -> np.ndarray:
        """Of all pairs, a call each."""
        return np.array([self.distance(*call) for call in self.calls])

    def distance(self, first: Any, second: Any, pose: Any) -> float:
        """Signed distance of one pair."""
        result = coal.DistanceResult()
        return coal.distance(first, self.identity, second, pose, self.request, result)

    def overhead(self) -> None:
        """As many calls that compute next to nothing."""
        sphere, pose = coal.Sphere(0.1), self.calls[0][2]
        for _ in self.calls:
            self.distance(sphere, sphere, pose)


def cpu(action: Callable[[], Any], repeats: int) -> float:
    """Least CPU seconds of an action."""
    seconds = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        seconds.append(time.process_time() - start)
    return min(seconds)


def print_table(title: str, pairs: Sequence[Pair], repeats: int) -> None:
    """A row a library: microseconds a pair, errors against the exact distance."""
    truth = np.array([exact(pair) for pair in pairs[:1000]])
    print(f"{title}: {len(pairs)} pairs; of {len(truth)} checked {np.sum(truth <= 0)} overlap")
    print("| | µs a pair | worst error, m | above 1 µm |\n| --- | --- | --- | --- |")
    rows: list[tuple[str, float, np.ndarray]] = [("ours", cpu(lambda: ours(pairs), repeats), ours(pairs))]
    for name, tolerance in (("coal, defaults", None), ("coal, 1e-10", 1e-10)):
        library = Coal(pairs, tolerance)
        seconds = cpu(library.distances, repeats)
        rows.append((f"{name}, calls included", seconds, library.distances()))
        rows.append((name, seconds - cpu(library.overhead, repeats), library.distances()))
    for name, seconds, found in rows:
        error = np.abs(found[: len(truth)] - truth)
        print(f"| {name} | {seconds / len(pairs) * 1e6:.2f} | {np.nanmax(error):.1e} | {np.nansum(error > 1e-6):.0f} |")


def main() -> None:
    """Prints both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    pairs = asked_pairs()
    np.random.default_rng(0).shuffle(pairs)
    print_table("as asked", pairs, repeats)
    print_table("moved together", [moved_together(pair) for pair in pairs[:4000]], repeats)


if __name__ == "__main__":
    main()
