#!/usr/bin/env bash
# Tries a wheel where there is neither compiler nor network: in a bare Debian of its own, made by mmdebstrap (needs root).
#
#   scripts/test_wheel.sh SUITE WHEEL     SUITE: bookworm (Python 3.11) or trixie (3.13)
#
# Evaluates and exports a design there; fails if a number of the evaluation differs from this build's by more than 1e-9.
set -euo pipefail
[ $# = 2 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" | head -n -1; exit 2; }
cd "$(dirname "$0")/.."
suite=$1 wheel=$(realpath "$2") here=$PWD
python=${PYTHON:-.venv/bin/python}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
design=(--study ironcub_paper --set angle=15 --set distance=42 --set offset=80 --set length=108)

echo "== a bare $suite"
mmdebstrap --quiet --variant=minbase --include=python3-venv,libgl1 "$suite" "$work/root"
version=$(chroot "$work/root" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')

echo "== packages for Python $version"
platforms=()
for glibc in 2_34 2_31 2_28 2_27 2_26 2_24 2_17; do platforms+=(--platform "manylinux_${glibc}_x86_64"); done
"$python" -m pip --disable-pip-version-check download --quiet --only-binary :all: --python-version "$version" \
  "${platforms[@]}" --platform manylinux2014_x86_64 --dest "$work/root/packages" "$wheel"

inside() { # COMMAND...: in the bare system, without its caches and ours
  chroot "$work/root" env -i HOME=/root LANG=C.UTF-8 PATH=/env/bin:/usr/bin:/bin "$@"
}
echo "== installing and evaluating there"
mount --bind /proc "$work/root/proc"
trap 'umount "$work/root/proc"; rm -rf "$work"' EXIT
inside python3 -m venv /env
inside pip --disable-pip-version-check install --quiet --no-index --find-links /packages codesign
inside codesign doctor
inside codesign evaluate "${design[@]}" --json > "$work/there.json"
inside codesign export "${design[@]}" --out /root/design
"$(dirname "$python")/codesign" evaluate "${design[@]}" --no-cache --json > "$work/here.json"
PYTHONPATH=benchmarks/revision "$python" - "$work/here.json" "$work/there.json" << 'END'
import json, sys
from report import leaves
here, there = (dict(leaves(json.load(open(file)))) for file in sys.argv[1:])
off = {
    path: (here[path], there.get(path))
    for path in here
    if here[path] != there.get(path)
    and not (isinstance(here[path], float) and abs(here[path] - (there.get(path) or 0.0)) <= 1e-9 * abs(here[path]))
}
print(f"{len(here)} values of the evaluation, {len(off)} off by more than 1e-9", *(f"{p}: {v}" for p, v in off.items()), sep="\n")
sys.exit(bool(off))
END
