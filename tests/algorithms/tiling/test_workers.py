"""Blocks on a Dask cluster: a real scheduler and its workers, in processes of their own, with certificates."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import read_cloud, write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.tiling import workers as workers_module
from lidar_buildings.algorithms.tiling.processes import own_python
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
from lidar_buildings.tests.builders import roof

DETECT, TERRAIN = PIPELINES["detect_buildings"], PIPELINES["model_terrain"]


@pytest.fixture
def tile(tmp_path):
    """A field with a house on it."""
    rng = np.random.default_rng(11)
    plan = rng.uniform(0, 60, (60 * 60 * 3, 2))
    under = ((plan > [24, 20]) & (plan < [36, 30])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    xyz = np.concatenate([ground, roof(rng, 24, 20, 12, 10, 5.0, density=3.0)]) + [85_000, 447_000, 0]
    write_cloud(create_cloud({"xyz": xyz}, "EPSG:28992"), tmp_path / "tile.las")
    return tmp_path / "tile.las"


@pytest.mark.parametrize(("installed", "processes"), [(16e9, 6), (4e9, 1), (1e9, 1), (256e9, 8), (np.inf, 8)])
def test_there_are_no_more_processes_than_memory_has_room_for(monkeypatch, installed, processes):
    """Of 16 GB three quarters are 12: six processes of 1.8 GB. A number that is given counts as it is."""
    monkeypatch.setattr(workers_module, "installed_memory", lambda: installed)
    monkeypatch.setattr(workers_module, "n_threads", lambda: 8)
    assert Workers().count(1.8e9) == processes
    assert Workers(processes=3).count(1.8e9) == 3


def certificates(folder):
    """Make an authority, and a certificate and key that it has signed."""
    for arguments in (
        "req -x509 -newkey rsa:2048 -nodes -keyout ca.key -out ca.pem -days 2 -subj /CN=authority",
        "req -newkey rsa:2048 -nodes -keyout key.pem -out request.pem -subj /CN=localhost",
        "x509 -req -in request.pem -CA ca.pem -CAkey ca.key -CAcreateserial -out cert.pem -days 2",
    ):
        subprocess.run(["openssl", *arguments.split()], cwd=folder, check=True, capture_output=True)
    return tuple(str(folder / name) for name in ("ca.pem", "cert.pem", "key.pem"))


def started(arguments, folder):
    environment = {**os.environ, "DASK_DISTRIBUTED__WORKER__DAEMON": "False"}
    with (folder / f"{len(list(folder.glob('*.log')))}.log").open("w") as log:
        return subprocess.Popen(
            [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]],
            cwd=folder,
            env=environment,
            stdout=log,
            stderr=log,
            start_new_session=True,
        )


@pytest.fixture
def cluster(tmp_path, request):
    """A scheduler and two workers, or as many as asked for, on loopback, with certificates.

    Their address, certificates and processes, and a function that starts another worker.
    """
    pytest.importorskip("distributed")
    if shutil.which("openssl") is None:
        pytest.skip("openssl is not installed")
    folder = tmp_path / "cluster"
    folder.mkdir()
    authority, certificate, key = files = certificates(folder)
    tls = ["--tls-ca-file", authority, "--tls-cert", certificate, "--tls-key", key]
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address = f"tls://127.0.0.1:{port}"
    processes = [started(["dask_scheduler", "--host", address, "--no-dashboard", *tls], folder)]

    def join():
        one = ["dask_worker", address, "--nthreads", "1", "--no-dashboard", "--no-nanny", *tls]
        processes.append(started(one, folder))

    for _ in range(getattr(request, "param", 2)):
        join()
    yield address, files, processes, join
    for process in processes:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


class Killing(Monitor):
    """Kills a worker when the first block is done."""

    def __init__(self, process):
        super().__init__()
        self.process = process

    def progress(self, fraction):
        if fraction > 0.3 and self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()


def test_a_cluster_gives_what_this_machine_gives_though_a_worker_is_killed(tile, cluster, tmp_path):
    address, files, processes, _ = cluster
    expected = run_in_tiles(DETECT, [tile], tmp_path / "here", options=TilesOptions(Workers(processes=1), 30.0))
    workers = Workers(scheduler=address, certificates=files)
    begun = time.monotonic()
    options = TilesOptions(workers, 30.0)
    outcome = run_in_tiles(DETECT, [tile], tmp_path / "there", Killing(processes[1]), options)
    assert time.monotonic() - begun < 120
    assert processes[1].poll() is not None
    assert outcome.failures == []
    one, other = (read_cloud(path.tiles[0]).get("classification") for path in (expected, outcome))
    np.testing.assert_array_equal(one, other)
    assert len(outcome.layers["footprints"]) == 1
    assert Path(outcome.tiles[0]).is_file()


@pytest.mark.slow
def test_a_scheduler_that_ends_is_a_sentence_and_the_run_goes_on_with_another(tile, cluster, tmp_path):
    """It was Python's CancelledError, without a word."""
    address, files, processes, _ = cluster
    options = TilesOptions(Workers(scheduler=address, certificates=files), 20.0)
    begun = time.monotonic()
    with pytest.raises(ValueError, match="The Dask scheduler has ended or dropped the work; start it and the same"):
        run_in_tiles(DETECT, [tile], tmp_path / "there", Killing(processes[0]), options)
    assert time.monotonic() - begun < 120
    monitor = Monitor()
    outcome = run_in_tiles(DETECT, [tile], tmp_path / "there", monitor, TilesOptions(Workers(processes=1), 20.0))
    assert outcome.failures == []
    assert [one for one in monitor.infos if "were worked on before" in one]


class Joining(Monitor):
    """Starts a worker once the log has said that there is none."""

    def __init__(self, start):
        super().__init__()
        self.start = start

    def inform(self, sentence):
        super().inform(sentence)
        if "has no workers" in sentence and self.start:
            self.start()
            self.start = None


@pytest.mark.parametrize("cluster", [0], indirect=True)
def test_a_scheduler_without_workers_is_said(tile, cluster, tmp_path, monkeypatch):
    """The run waited for ever, without a word."""
    monkeypatch.setattr(workers_module, "BETWEEN_MESSAGES", 1.0)
    address, files, _, join = cluster
    monitor = Joining(join)
    options = TilesOptions(Workers(scheduler=address, certificates=files), 30.0)
    assert run_in_tiles(TERRAIN, [tile], tmp_path / "there", monitor, options).failures == []
    assert [one for one in monitor.infos if one.startswith("Waiting for 6 of 6 tasks: the Dask scheduler has no work")]


@pytest.mark.skipif(os.name == "nt", reason="a script is no program on Windows")
@pytest.mark.parametrize("name", ["python3", "qgis.bin"])
def test_processes_are_started_with_the_interpreter_that_runs(tmp_path, monkeypatch, name):
    """In QGIS, ``sys.executable`` is QGIS or the first Python on the PATH; processes then failed to import numpy."""
    other = tmp_path / name
    other.write_text("#!/bin/sh\necho 3.9.1 /opt/other/lib/python3.9/os.py\n")
    other.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(other))
    monkeypatch.setattr(sys, "exec_prefix", sys.base_exec_prefix)
    answer = subprocess.check_output([own_python(), "-c", "import sys; print(sys.version)"], text=True)
    assert answer.strip() == sys.version
