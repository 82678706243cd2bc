"""Dask: the same rows as a local run, and nothing lost when workers go and come."""

import os
import signal
import socket
import threading
import time
from pathlib import Path

import distributed
import pytest

from codesign.errors import ExecutionError
from codesign.execution.cluster import local_cache
from codesign.search.optimization import optimize
from codesign.storage.runs import Run
from fake_study import FakeStudy, study

pytestmark = pytest.mark.filterwarnings("ignore")


def identities(run: Run) -> list[dict]:
    return [record.identity() for record in run.search_records]


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Run:
    return optimize(fake(), out=tmp_path_factory.mktemp("local") / "run", cache=None, generations=5)


def fake(**options) -> FakeStudy:
    return study(hash="h", faults={"12,6,3": "segfault", "3,3,3": "raise"}, **options)


def test_local_cluster_gives_the_same_rows(tmp_path, whole: Run) -> None:
    run = optimize(fake(jitter=0.02), out=tmp_path / "run", cluster="local:2", cache=None, generations=5)
    assert identities(run) == identities(whole)


@pytest.mark.parametrize("address", ["local:0", "local:x", "local:-1", "local:", "here", ""])
def test_addresses_that_make_no_sense_are_refused_at_once(tmp_path, address) -> None:
    with pytest.raises(ExecutionError, match="expected"):
        optimize(fake(), out=tmp_path / "run", cluster=address, cache=None, generations=5)
    assert not (tmp_path / "run").exists()


def test_a_cluster_that_is_not_there_leaves_what_the_folder_held(tmp_path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    with pytest.raises(ExecutionError, match="expected"):
        optimize(fake(), out=folder, cluster="local:0", cache=None, generations=5)
    assert [path.name for path in folder.iterdir()] == ["notes.txt"]
    assert optimize(fake(), out=folder, workers=1, cache=None, generations=1).evaluations


def test_lost_and_joined_workers_lose_nothing(tmp_path, whole: Run) -> None:
    """A Dask worker is killed in mid-run, another joins later."""
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids = list(client.run(os.getpid).values())
        log = tmp_path / "log"
        disturbance = threading.Thread(target=disturb, args=(cluster, pids[0], log))
        disturbance.start()
        study = fake(seconds=0.1, log=str(log))
        run = optimize(study, out=tmp_path / "run", cluster=cluster.scheduler_address, cache=None, generations=5)
        disturbance.join()
        assert pids[0] not in client.run(os.getpid).values()
    assert identities(run) == identities(whole)
    assert not failures(run) - failures(whole)


def disturb(cluster, pid: int, log: Path) -> None:
    while not log.exists() or len(log.read_text().splitlines()) < 10:
        time.sleep(0.02)
    os.kill(pid, signal.SIGKILL)
    cluster.scale(3)


def failures(run: Run) -> set[str | None]:
    return {evaluation.reason for evaluation in run.evaluations if evaluation.status == "failed"}


def test_unreachable_scheduler_is_a_clear_error(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("codesign.execution.cluster.CONNECT_LIMIT", 0.2)
    with pytest.raises(ExecutionError, match="no Dask cluster at tcp://"):
        optimize(fake(), out=tmp_path / "run", cluster="tcp://127.0.0.1:1", cache=None, generations=1)


def test_other_machines_have_their_own_cache() -> None:
    """A cache in a home folder on NFS must not be written from two machines."""
    assert local_cache("/home/me/.cache/codesign/x.sqlite", socket.gethostname()) == "/home/me/.cache/codesign/x.sqlite"
    elsewhere = local_cache("/home/me/.cache/codesign/x.sqlite", "login-node")
    assert not elsewhere.startswith("/home")
    assert elsewhere.endswith("/x.sqlite")
    assert local_cache("", "login-node") == ""
