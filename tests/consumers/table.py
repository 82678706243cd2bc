"""What other programs keep of ten exported designs, as the table of docs/exchange.md.

PYTHONPATH=tests/python .venv/bin/python tests/consumers/table.py
"""

import tempfile
from importlib.metadata import version
from pathlib import Path

from test_ten_designs import FLOWN, POSTURES, STUDY, ten_designs

from exported_robots import export_robot
from robot_readers import READERS, USD, contacts_in_flight, differences, usd_differences

FIND_CONTACTS = ("MuJoCo", "Drake")
COLUMNS = ("mass", "com", "inertia", "frames", "gravity")
HEAD = (
    "read by",
    "mass kg",
    "center of mass m",
    "locked inertia, relative",
    "frames",
    "gravity torques Nm",
    "contacts",
)


def main() -> None:
    """Prints the table; the largest differences over all designs."""
    rows: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as name:
        for k, theta in enumerate(ten_designs()):
            exported = export_robot(STUDY, theta, Path(name) / str(k) / "robot", FLOWN)
            for title, (package, make) in READERS.items():
                reader = make(exported)
                found = differences(exported, reader, POSTURES)
                if title.startswith(FIND_CONTACTS):
                    found["contacts"] = contacts_in_flight(exported, reader)
                _keep(rows, title.replace(",", f" {version(package)},"), found)
            package, title = USD
            _keep(
                rows,
                title.replace(",", f" ({package} {version(package)}),"),
                usd_differences(exported, Path(name, f"u{k}")),
            )
    print("|", " | ".join(HEAD), "|")
    print("|", " | ".join(["---"] * len(HEAD)), "|")
    for title, found in rows.items():
        cells = [f"{found[key]:.1g}" if key in found else "–" for key in COLUMNS]
        contacts = f"{found['contacts']}" if "contacts" in found else "–"
        print("|", " | ".join([title, *cells, contacts]), "|")


def _keep(rows: dict[str, dict[str, float]], title: str, found: dict[str, float]) -> None:
    row = rows.setdefault(title, {})
    for key, value in found.items():
        row[key] = max(row.get(key, 0), value)


if __name__ == "__main__":
    main()
