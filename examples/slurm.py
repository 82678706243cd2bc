"""A study on a Slurm cluster: Dask workers as Slurm jobs, the search here.

  python examples/slurm.py --study ironcub --jobs 8 --cores 16 --partition compute --out runs/cluster
  python examples/slurm.py --print                    the batch script that would be submitted
  python examples/slurm.py --local 2 --out runs/try   the same on this machine, without Slurm

Needs `pip install codesign[cluster] dask-jobqueue`. Run it on a login or service node that the compute nodes can reach,
in the virtual environment that they see too. Jobs may end and others start at any time: their designs are evaluated
again. Ctrl-C or a lost login session loses nothing: `codesign resume runs/cluster` goes on, on any cluster or none.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

from codesign.search.optimization import optimize
from codesign.search.progress import ProgressBar


def slurm_cluster(given: argparse.Namespace) -> Any:
    """Slurm jobs that hold one Dask worker with one thread per core; every thread runs one evaluation at a time."""
    from dask_jobqueue import SLURMCluster

    return SLURMCluster(
        queue=given.partition,
        account=given.account,
        cores=given.cores,
        processes=1,
        memory=f"{2 * given.cores}GB",
        walltime=given.walltime,
        # A worker that ends a little before its job hands its tasks back at once instead of being lost.
        worker_extra_args=["--lifetime", given.lifetime, "--lifetime-stagger", "2m"],
        job_script_prologue=[f"source {sys.prefix}/bin/activate"],
        scheduler_options={"dashboard_address": ":0"},
    )


def main() -> None:
    """Parses the arguments, starts the cluster, runs the search."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", default="ironcub")
    parser.add_argument("--out", default="runs/cluster")
    parser.add_argument("--population", type=int, default=None)
    parser.add_argument("--generations", type=int, default=None)
    parser.add_argument("--jobs", type=int, default=4)
    parser.add_argument("--cores", type=int, default=8)
    parser.add_argument("--partition", default=None)
    parser.add_argument("--account", default=None)
    parser.add_argument("--walltime", default="04:00:00")
    parser.add_argument("--lifetime", default="230m", help="of a worker; a little less than the walltime")
    parser.add_argument("--local", type=int, default=0, metavar="N", help="N local Dask workers instead of Slurm jobs")
    parser.add_argument("--print", action="store_true", help="print the batch script and stop")
    given = parser.parse_args()

    if given.local:
        from distributed import LocalCluster

        cluster: Any = LocalCluster(n_workers=given.local, threads_per_worker=1, dashboard_address=None)
    else:
        cluster = slurm_cluster(given)
    with cluster:
        if given.print:
            print(cluster.job_script())
            return
        if not given.local:
            cluster.adapt(minimum_jobs=1, maximum_jobs=given.jobs)
        cores = given.local or given.jobs * given.cores
        with ProgressBar(given.study) as bar:
            run = optimize(
                given.study,
                out=given.out,
                population=given.population,
                generations=given.generations,
                steady=True,  # no core waits for the slowest design of a generation
                lag=max(25, 4 * cores),
                cluster=cluster.scheduler_address,
                progress=bar,
            )
    print(f"{run.out}: {run.counts}, {len(run.front)} designs on the front")


if __name__ == "__main__":
    main()
