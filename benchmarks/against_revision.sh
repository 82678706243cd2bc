#!/usr/bin/env bash
# Compares what is built here with an earlier revision, on the same Python packages.
#
#   benchmarks/against_revision.sh REV
#       CPU time of each stage: median of ROUNDS (5) alternating runs, one thread, ratio here / REV, and of REV against
#       itself (what the machine's noise is)
#   benchmarks/against_revision.sh --designs COUNT REV
#       CPU time a random design of COUNT new ones in one process (parts and whole evaluations), in the same way
#   benchmarks/against_revision.sh --results REV
#       all numbers of ten designs and of a run of 12 x 3, bit for bit; exit code 1 if any differs (times, hashes and
#       provenance apart)
#
# REV is built in build/revisions/COMMIT, with ccache if it is there. PYTHON: the environment to compare (.venv/bin/python).
# Leave the sources alone while it runs: workers that load another program than the run are refused.
set -euo pipefail
cd "$(dirname "$0")/.."
kind=(times)
if [ "${1:-}" = --results ]; then kind=(results); shift; fi
if [ "${1:-}" = --designs ]; then kind=(designs "$2"); shift 2; fi
[ $# = 1 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" | head -n -1; exit 2; }
python=${PYTHON:-.venv/bin/python}
commit=$(git rev-parse --short=12 --verify "$1^{commit}")
place=$PWD/build/revisions/$commit
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
case $python in /*) ;; *) python=$PWD/$python ;; esac
export PATH="$(dirname "$python"):$PATH"

# The revision's own environment: its package and core, the packages of the environment here.
build_revision() {
  [ -e "$place/done" ] && return
  mkdir -p "$place"
  [ -e "$place/source" ] || { git worktree prune; git worktree add --detach "$place/source" "$commit"; }
  "$python" -m venv --without-pip "$place/venv"
  local site
  site=$("$place/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
  "$python" -c 'import sys; print(*[p for p in sys.path if p.endswith("-packages")], sep="\n")' > "$site/shared.pth"
  CCACHE_BASEDIR=$place/source CCACHE_NOHASHDIR=1 "$place/venv/bin/python" -m pip --disable-pip-version-check install \
    --verbose --no-deps --no-build-isolation --ignore-installed "$place/source"
  touch "$place/done"
}

build_revision >&2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
declare -A interpreter=([here]=$python [revision]=$place/venv/bin/python [again]=$place/venv/bin/python)

job() { # NAME ARGUMENTS...: from an empty folder, so that no source tree is on the path
  local name=$1
  shift
  (cd "$work" && CODESIGN_CACHE=$work/cache-$name "${interpreter[$name]}" -P "$OLDPWD/benchmarks/revision/job.py" "$@")
}

if [ "${kind[0]}" = results ]; then
  for name in here revision; do job $name results "$work/$name.json"; done
  "$python" benchmarks/revision/report.py results "$work/here.json" "$work/revision.json"
else
  order=(here revision again)
  for ((round = 0; round < ${ROUNDS:-5}; round++)); do
    for k in 0 1 2; do
      name=${order[(k + round) % 3]}
      printf '%s %s\n' "$name" "$(job "$name" "${kind[@]}" 2> "$work/$name.places")" >> "$work/times"
    done
    echo "round $((round + 1)) of ${ROUNDS:-5}" >&2
  done
  cat "$work"/{here,revision}.places >&2
  "$python" benchmarks/revision/report.py times "$work/times"
fi
