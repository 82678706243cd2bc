"""What an analysis holds stays within its memory limit, by whatever way that leads to."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from codesign import fem
from codesign.errors import MemoryLimitError
from codesign.geometry.profile import Resolution
from codesign.geometry.shape import box
from codesign.geometry.solid import build_solid
from codesign.parts.surface import surface_mesh

MARGIN = 1.15  # CHOLMOD's work space, the stress of the result, what the allocator keeps
ALUMINIUM = fem.Material("aluminium", 72e9, 0.33, 2810.0, 462e6)
HELD = [fem.Support("root")]
LOADS = [fem.Traction("tip", [0, 0, -1e5])]


def plate():
    shape = box((0, 0, 0), (100, 100, 4), x0="root", x1="tip")
    return fem.tetrahedralize(surface_mesh(build_solid(shape, Resolution(8))), 3.2e-3)


def factor_bytes(mesh):
    """What stiffness and factor take, as the refusal says."""
    with pytest.raises(MemoryLimitError) as refused:
        fem.StaticSystem(mesh, ALUMINIUM, HELD, solver="direct", memory_limit=1.0)
    return float(re.search(r"about (\d+) MiB", str(refused.value))[1]) * 2**20


def resident(key):
    """[bytes] VmRSS, or VmHWM, its peak."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) * 1024.0 for line in lines if line.startswith(key))


def growth(what, share):
    """Peak of an analysis beyond what was there before, as a share of its limit, and its iterations.

    share: the limit, as one of factor_bytes.
    """
    mesh = plate()
    limit = share * factor_bytes(mesh)
    before = resident("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # the peak counts from here
    count = 6 if what == "modes" else 2 if what == "buckling" else 0
    system = fem.StaticSystem(mesh, ALUMINIUM, HELD, memory_limit=limit, eigenvalues=count)
    iterations = system.solve(LOADS).iterations
    if what == "modes":
        system.natural_frequencies(count)
    if what == "buckling":
        system.buckling_factors(LOADS, count)
    return (resident("VmHWM") - before) / limit, iterations


@pytest.mark.parametrize(
    ("what", "share", "by_factor"),
    [
        ("static", 1.01, True),
        ("static", 0.8, False),
        ("modes", 1.01, False),  # the factor would fit, but not the second matrix and the vectors beside it
        ("modes", 2.2, True),
        ("buckling", 1.6, True),
    ],
)
def test_an_analysis_stays_within_its_limit(what, share, by_factor):
    command = [sys.executable, __file__, what, str(share)]  # a process of its own, whose memory nobody else has used
    told = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
    assert 0.1 < float(told[0]) < MARGIN
    assert (int(told[1]) == 0) == by_factor


def test_a_negative_number_of_eigenvalues_is_refused():
    with pytest.raises(ValueError, match="eigenvalues"):
        fem.StaticSystem(plate(), ALUMINIUM, HELD, eigenvalues=-1)


if __name__ == "__main__":
    print(*growth(sys.argv[1], float(sys.argv[2])))
