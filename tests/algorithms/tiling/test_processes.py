"""Worker processes that are killed, can't start or outlive their program; files of a survey that pose as modules."""

import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from lidar_buildings.algorithms.cloud.cloud import create_cloud
from lidar_buildings.algorithms.cloud.files import write_cloud
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stage import Cancelled, Monitor
from lidar_buildings.algorithms.tiling import processes, workers
from lidar_buildings.algorithms.tiling.block_result import BlockResult
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.work_folder import remove_work, work_folder
from lidar_buildings.algorithms.tiling.workers import Workers, run_all
from lidar_buildings.tests.builders import roof
from lidar_buildings.tests.monitors import Listening

ROOT = Path(__file__).resolve().parents[3]
TERRAIN = PIPELINES["model_terrain"]

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="processes are found in /proc, and killed as Linux does"
)


@pytest.fixture(scope="module")
def survey(tmp_path_factory):
    """Four tiles of 30 m with a house on their common corner, some 12,000 points."""
    rng = np.random.default_rng(5)
    folder = tmp_path_factory.mktemp("survey")
    plan = rng.uniform(0, 60, (12_000, 2))
    under = ((plan > [24, 25]) & (plan < [36, 35])).all(axis=1)
    ground = np.column_stack([plan, rng.normal(0, 0.02, len(plan))])[~under]
    xyz = np.concatenate([ground, roof(rng, 24, 25, 12, 10, 5.0, density=4.0)])
    east, north = (xyz[:, :2] >= 30).T
    for column in (False, True):
        for row in (False, True):
            tile = xyz[(east == column) & (north == row)] + [85_000, 447_000, 0]
            write_cloud(create_cloud({"xyz": tile}, "EPSG:28992"), folder / f"t_{column:d}_{row:d}.las")
    return folder


def workers_of(main):
    """Return the processes of this machine that ``main`` has started as workers."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(stat.read_text().rsplit(")", 1)[1].split()[1])
            line = (stat.parent / "cmdline").read_bytes()
        except OSError:
            # It has ended meanwhile.
            continue
        if b"worker_process.py" in line and parent == main:
            found.append(int(stat.parent.name))
    return found


def is_running(number):
    try:
        return Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def run(survey, folder, monitor=None, **options):
    return run_in_tiles(TERRAIN, [survey], folder, monitor, TilesOptions(block_side=20.0, compressed=False, **options))


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


@pytest.fixture(scope="module")
def whole(survey, tmp_path_factory):
    """What a run in this process gives."""
    folder = tmp_path_factory.mktemp("whole")
    run(survey, folder, workers=Workers(processes=1))
    return contents(folder)


class KillingAt(Monitor):
    """Kills one of the workers, by ``rng``, some time after the blocks have begun."""

    def __init__(self, rng, delay):
        super().__init__()
        self.rng, self.delay, self.killed = rng, delay, 0

    def progress(self, fraction):
        if fraction > 0.1 and not self.killed:
            self.killed = -1
            threading.Timer(self.delay, self._kill).start()

    def _kill(self):
        found = workers_of(os.getpid())
        if found:
            self.killed = int(self.rng.choice(found))
            os.kill(self.killed, signal.SIGKILL)


@pytest.mark.parametrize("seed", range(int(os.environ.get("KILLS", "1"))))
def test_a_killed_worker_costs_nothing_but_time(survey, whole, tmp_path, seed):
    """It hung every survey: tasks were larger than the buffer of the pipe that all processes shared."""
    rng = np.random.default_rng(seed)
    monitor = KillingAt(rng, rng.uniform(0, 0.4))
    begun = time.monotonic()
    outcome = run(survey, tmp_path / "out", monitor, workers=Workers(processes=2))
    assert time.monotonic() - begun < 60
    assert monitor.killed > 0
    assert outcome.failures == []
    assert contents(tmp_path / "out") == whole
    assert workers_of(os.getpid()) == []


def kill_oneself(task):
    """Work on a task of which some end the process."""
    if task[0]:
        os.kill(os.getpid(), signal.SIGKILL)
    return len(task[1])


def test_tasks_that_end_their_process_twice_are_named_and_all_others_done(tmp_path):
    tasks = [(number in (1, 4), bytes(1_000_000)) for number in range(8)]
    with Workers(processes=2).open() as executor:
        results, failed = run_all(executor, kill_oneself, tasks, tmp_path / "stop", Monitor(), lambda number: None)
    assert results == {number: 1_000_000 for number in (0, 2, 3, 5, 6, 7)}
    assert sorted(failed) == [1, 4]
    assert all("fewer processes or smaller blocks" in why for why in failed.values())


def test_processes_that_cant_start_are_a_sentence(survey, tmp_path, monkeypatch):
    broken = tmp_path / "python3"
    broken.write_text("#!/bin/sh\necho no numpy here >&2\nexit 3\n")
    broken.chmod(0o755)
    for python, why in ((broken, "no numpy here"), (tmp_path / "missing", "No such file")):
        monkeypatch.setattr(processes, "own_python", lambda python=python: str(python))
        with pytest.raises(ValueError, match=f"can't be started .*{why}.*set the number of processes to 1"):
            run(survey, tmp_path / "out", workers=Workers(processes=2))


def test_a_worker_that_is_killed_while_it_starts_costs_nothing_but_time(survey, whole, tmp_path, monkeypatch):
    """It ended the survey, with the advice to use one process; later kills were survived."""
    starting = tmp_path / "python3"
    starting.write_text(f'#!/bin/sh\nif mkdir "{tmp_path}/once"; then kill -9 $$; fi\nexec {sys.executable} "$@"\n')
    starting.chmod(0o755)
    monkeypatch.setattr(processes, "own_python", lambda: str(starting))
    outcome = run(survey, tmp_path / "out", workers=Workers(processes=2))
    assert (tmp_path / "once").is_dir()
    assert outcome.failures == []
    assert contents(tmp_path / "out") == whole


class Continuing(Monitor):
    """Has stopped workers go on once the log has named one."""

    def inform(self, sentence):
        super().inform(sentence)
        for number in workers_of(os.getpid()):
            os.kill(number, signal.SIGCONT)


def stop_oneself(once):
    """Stop this process, as a terminal or a debugger does."""
    if not once.exists():
        once.touch()
        os.kill(os.getpid(), signal.SIGSTOP)
    return 1


def test_what_is_waited_for_is_said(tmp_path, monkeypatch):
    """A worker that was stopped held the run up for ever, without a word."""
    monkeypatch.setattr(workers, "BETWEEN_MESSAGES", 1.0)
    monitor = Continuing()
    with Workers(processes=2).open() as executor:
        results, failed = run_all(
            executor, stop_oneself, [tmp_path / "once"], tmp_path / "stop", monitor, lambda number: None
        )
    assert (results, failed) == ({0: 1}, {})
    assert re.fullmatch(r"Waiting for 1 of 1 tasks: process \d+ has been at work for \d+ s\.", monitor.infos[-1])


def sleep(seconds):
    time.sleep(seconds)


def test_a_cancel_ends_work_that_does_not_look(tmp_path):
    begun = time.monotonic()
    with pytest.raises(Cancelled), Workers(processes=2).open() as executor:
        run_all(executor, sleep, [60.0] * 4, tmp_path / "stop", Listening(stop_at=0.0), lambda number: None)
    assert time.monotonic() - begun < 10
    assert workers_of(os.getpid()) == []


def test_a_block_s_task_is_small(survey, tmp_path, monkeypatch):
    """Each carried samples of the cloud, 6 to 9 MB; a survey of 10,000 blocks moved 60 GB and more."""
    sizes = []
    submit = processes.Processes.submit
    monkeypatch.setattr(
        processes.Processes,
        "submit",
        lambda self, fn, *args: sizes.append(len(pickle.dumps(args))) or submit(self, fn, *args),
    )
    options = TilesOptions(Workers(processes=2), 30.0)
    run_in_tiles(PIPELINES["detect_buildings"], [survey], tmp_path / "out", options=options)
    assert len(sizes) > 6
    assert max(sizes) < 10_000


MAIN = """
import sys
sys.path.insert(0, sys.argv[1])
import conftest
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.tiling.run_in_tiles import run_in_tiles
from lidar_buildings.algorithms.tiling.tiled_run import TilesOptions
from lidar_buildings.algorithms.tiling.workers import Workers
print("started", flush=True)
options = TilesOptions(Workers(processes=2), 20.0)
run_in_tiles(PIPELINES["model_terrain"], [sys.argv[2]], sys.argv[3], options=options)
print("done", flush=True)
"""


def test_workers_end_with_their_program(survey, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(MAIN)
    command = [sys.executable, str(script), str(ROOT), str(survey), str(tmp_path / "out")]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as main:
        deadline = time.monotonic() + 60
        while len(found := workers_of(main.pid)) < 2 and time.monotonic() < deadline:
            time.sleep(0.05)
        main.kill()
    assert len(found) == 2
    deadline = time.monotonic() + 5
    while any(map(is_running, found)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(map(is_running, found))
    # The next run goes on with what is there.
    assert run(survey, tmp_path / "out", workers=Workers(processes=1)).failures == []


SLEEPING = """
import sys, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import conftest
from lidar_buildings.algorithms.stage import Monitor
from lidar_buildings.algorithms.tiling.workers import Workers, run_all
with Workers(processes=2).open() as executor:
    run_all(executor, time.sleep, [60.0] * 2, Path(sys.argv[2]), Monitor(), lambda number: None)
"""


def test_workers_end_with_their_program_in_the_middle_of_long_work(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SLEEPING)
    with subprocess.Popen([sys.executable, str(script), str(ROOT), str(tmp_path / "stop")]) as main:
        deadline = time.monotonic() + 60
        while len(found := workers_of(main.pid)) < 2 and time.monotonic() < deadline:
            time.sleep(0.05)
        # Both have their calls by then.
        time.sleep(3)
        main.kill()
    assert len(found) == 2
    deadline = time.monotonic() + 5
    while any(map(is_running, found)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(map(is_running, found))


def test_no_file_of_the_current_folder_or_the_survey_is_imported(survey, tmp_path):
    """A module next to the tiles was run by every worker; a script without a main guard was run again in each."""
    data = tmp_path / "survey"
    data.mkdir()
    for path in survey.iterdir():
        (data / path.name).write_bytes(path.read_bytes())
    for name in ("multiprocessing", "numpy", "json", "queue", "sitecustomize", "usercustomize", "laspy", "socket"):
        (data / f"{name}.py").write_text(f"open({str(tmp_path / 'planted')!r}, 'a').write({name!r})\n")
    script = tmp_path / "script.py"
    script.write_text(MAIN)
    command = [sys.executable, str(script), str(ROOT), str(data), str(tmp_path / "out")]
    made = subprocess.run(command, cwd=data, capture_output=True, text=True, timeout=100, check=False)
    assert made.stdout.split() == ["started", "done"], made.stderr
    assert not (tmp_path / "planted").exists()


def test_the_search_path_of_workers_has_no_folder_of_data_and_none_that_is_relative(tmp_path):
    path = ["", ".", "modules", str(tmp_path), str(tmp_path / "tiles" / ".."), "/usr/lib"]
    assert processes._trusted(path, {tmp_path.resolve()}) == ["/usr/lib"]


def moved(path):
    """Write a result whose points are none of the files', as the program itself writes it."""
    result = BlockResult.read(path)
    result.position += 1_000_000
    result.write(path)


def other_shape(path):
    """Write all arrays anew, one of them with an axis more."""
    with np.load(path) as stored:
        arrays = dict(stored)
    np.savez(path, **{**arrays, "position": arrays["position"][None]})


def locked(path):
    """Set the bit of the archive by which Python takes its first array for encrypted."""
    raw = bytearray(path.read_bytes())
    raw[raw.rindex(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(raw)


def flipped(path):
    """Change a bit in the middle, where the points are."""
    raw = bytearray(path.read_bytes())
    raw[len(raw) // 2] ^= 1
    path.write_bytes(raw)


DAMAGES = (
    lambda path: path.write_bytes(path.read_bytes()[:5000]),
    lambda path: np.savez(path, source=np.array([object()], object)),
    lambda path: path.write_bytes(b""),
    moved,
    other_shape,
    locked,
    flipped,
    lambda path: path.write_bytes(b"not ours" + path.read_bytes()),
    lambda path: np.savez_compressed(path, source=np.zeros(10_000_000)),
)


def test_a_damaged_result_of_a_block_is_worked_on_again(survey, whole, tmp_path):
    with pytest.raises(Cancelled):
        run(survey, tmp_path / "out", Listening(stop_at=0.87), workers=Workers(processes=1))
    work = tmp_path / "out" / ".lidar-buildings"
    found = sorted(work.glob("block-*.npz"), key=lambda path: -path.stat().st_size)
    for path, damage in zip(found, DAMAGES):
        damage(path)
    n_damaged = len(DAMAGES)
    assert [BlockResult.is_complete(path, [20_000] * 4) for path in found] == [
        at >= n_damaged for at in range(len(found))
    ]
    assert len(found) > n_damaged
    assert run(survey, tmp_path / "out", workers=Workers(processes=1)).failures == []
    assert contents(tmp_path / "out") == whole


def link_of_tile(survey, out, elsewhere):
    (out / "t_0_0.las").symlink_to(survey / "t_1_1.las")


def hard_link_of_tile(survey, out, elsewhere):
    os.link(survey / "t_1_1.las", out / "t_0_0.las")


def link_of_vpc(survey, out, elsewhere):
    (out / "out.vpc").symlink_to(survey / "t_1_1.las")


def link_of_work(survey, out, elsewhere):
    (out / ".lidar-buildings").symlink_to(elsewhere)


def link_of_numbers(survey, out, elsewhere):
    (out / ".lidar-buildings").mkdir()
    (out / ".lidar-buildings" / "lock").touch()
    (out / ".lidar-buildings" / "numbers-85000_447000.npz").symlink_to(survey / "t_1_1.las")


def link_of_lock(survey, out, elsewhere):
    (out / ".lidar-buildings").mkdir()
    (out / ".lidar-buildings" / "lock").symlink_to(survey / "t_1_1.las")


def folder_of_the_user(survey, out, elsewhere):
    (out / ".lidar-buildings").mkdir()
    (out / ".lidar-buildings" / "mine.txt").write_text("kept")


@pytest.mark.parametrize(
    "plant",
    [link_of_tile, hard_link_of_tile, link_of_vpc, link_of_work, link_of_numbers, link_of_lock, folder_of_the_user],
)
def test_nothing_is_written_through_a_link(survey, tmp_path, plant):
    """Inputs were overwritten through links that lay in the folder of the tiles."""
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    out.mkdir()
    elsewhere.mkdir()
    (elsewhere / "stop").write_text("somebody's")
    plant(survey, out, elsewhere)
    before = contents(survey), contents(elsewhere), sorted(out.rglob("*"))
    with pytest.raises(ValueError, match="choose another folder"):
        run(survey, out, workers=Workers(processes=1))
    assert (contents(survey), contents(elsewhere), sorted(out.rglob("*"))) == before


def test_a_file_of_the_user_in_the_hidden_folder_stays(tmp_path):
    with work_folder(tmp_path) as work:
        for name in ("block-0_0-1.npz", "numbers-0_0.npz", "stop", "mine.txt"):
            (work / name).write_text(name)
        (work / "pieces").mkdir()
    remove_work(work)
    assert {path.name for path in work.iterdir()} == {"lock", "mine.txt"}
    (work / "mine.txt").unlink()
    remove_work(work)
    assert not work.exists()
