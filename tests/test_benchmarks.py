"""Benchmarks measure and judge nothing; what they write is held to its form."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lidar_buildings.algorithms.terrain import free_standing
from lidar_buildings.tests.benchmarks import benchmark, history, measured, worth
from lidar_buildings.tests.benchmarks.classes import rates
from lidar_buildings.tests.benchmarks.results import Table
from lidar_buildings.tests.benchmarks.surveys import Job, simulate

FOLDER = Path(__file__).resolve().parent / "benchmarks"

# Constants behind *Detect buildings*, wires, water and vegetation left out.
MOST_CONSTANTS = 177


def test_a_table_is_markdown_for_people_and_json_for_programs(tmp_path, capsys):
    table = Table("towns", "town", "points", "F, %", "s")
    table.add("as it comes", np.int64(1200), np.float64(98.76), None)
    assert capsys.readouterr().out == (
        "\n| town | points | F, % | s |\n| --- | ---: | ---: | ---: |\n| as it comes | 1200 | 98.8 |  |\n"
    )
    path = table.write(tmp_path / "new" / "folder")
    assert path == tmp_path / "new" / "folder" / "towns.json"
    content = json.loads(path.read_text(encoding="utf-8"))
    assert content["table"] == "towns"
    assert content["rows"] == [{"town": "as it comes", "points": 1200, "F, %": 98.76, "s": None}]
    assert {"version", "commit", "changed", "date", "machine"} < set(content)
    assert {"cores", "python", "numpy", "scipy"} < set(content["machine"])


def test_what_is_no_number_is_null(tmp_path):
    """JSON has no NaN, and other programs refuse a file with it."""
    table = Table("empty", "of", "mean", texts=1)
    table.add("none", float("nan"))
    assert json.loads(table.write(tmp_path).read_text(encoding="utf-8"))["rows"] == [{"of": "none", "mean": None}]


def test_rates_of_merged_classes_leave_out_points_that_nobody_classified():
    """Of four points of plants one is missed and one is another plant; the car of class 1 does not count."""
    true, made = np.array([2, 2, 3, 4, 5, 5, 1]), np.array([2, 2, 3, 5, 5, 1, 3])
    accuracy, ground, plants, *others = rates(true, made)
    assert (accuracy, ground, plants) == pytest.approx((500 / 6, 100.0, 600 / 7))
    assert others == [None] * 4


def test_a_row_has_as_many_cells_as_the_table_and_no_heading_comes_twice():
    with pytest.raises(ValueError, match="A row of towns needs 2 cells, it has 1"):
        Table("towns", "town", "F").add("as it comes")
    with pytest.raises(ValueError, match="must have different headings"):
        Table("towns", "town", "s", "s")


@pytest.mark.parametrize(
    "script", ["accuracy.py", "benchmark.py", "models.py", "structure.py", "surveys.py", "worth.py"]
)
def test_every_script_starts_and_says_where_its_results_go(script):
    done = subprocess.run([sys.executable, FOLDER / script, "--help"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "--output" in done.stdout


def test_every_step_of_detect_buildings_is_measured_on_what_the_steps_before_it_left(tmp_path, monkeypatch):
    def in_this_process(command, **_):
        return SimpleNamespace(returncode=0, stdout=json.dumps(measured.main(json.loads(command[2]))))

    monkeypatch.setattr(benchmark.subprocess, "run", in_this_process)
    bench = benchmark.Bench(0.03, tmp_path, tmp_path)
    # It is the last but for the removal of auxiliary codes, and reads a layer of the step before.
    bench.run(["report_buildings"])
    steps = [step.stage_name for step in benchmark.CHAIN.steps]
    until = steps[: steps.index("report_buildings") + 1]
    assert [row["name"] for row in bench.rows][-len(until) :] == until


def times(**cpu_seconds):
    """Return rows of a run on 0.1 million points, with a floor of 2 s unless another one is given."""
    return [
        {"name": name, "millions": 0.1, "cpu_seconds": s} for name, s in {history.FLOOR: 2.0, **cpu_seconds}.items()
    ]


def test_times_are_compared_in_units_of_the_floor_of_their_own_run():
    slower_machine = [{**row, "cpu_seconds": 3 * row["cpu_seconds"]} for row in times(ground=4.0, roofs=6.0)]
    compared = history.changes(times(ground=4.0, roofs=3.0, gone=1.0), [*slower_machine, *times(new=1.0)[1:]])
    assert compared == [(0.1, "ground", 2.0, 2.0), (0.1, "roofs", 1.5, 3.0)]


def test_other_sizes_and_runs_without_a_floor_are_not_compared():
    large = [{**row, "millions": 1.0} for row in times(ground=4.0)]
    assert history.changes(times(ground=4.0), large) == []
    assert history.changes(times(ground=4.0)[1:], times(ground=4.0)) == []


def test_each_commit_is_kept_once_and_compared_with_the_one_before(tmp_path):
    def run(commit, date, changed=False, **seconds):
        content = {"table": "times", "commit": commit, "changed": changed, "date": date, "rows": times(**seconds)}
        path = tmp_path / "times.json"
        path.write_text(json.dumps(content), encoding="utf-8")
        return history.sentences(history.keep_copy(path), tmp_path / "nothing published.json")

    assert run("a" * 40, "2026-01-01", ground=9.0) == ["No earlier results are kept to compare with."]
    run("a" * 40, "2026-01-02", ground=4.0)
    second = run("b" * 40, "2026-01-03", ground=3.0)
    assert "aaaaaaaaaaaa:" in second[0]
    assert second[1].split() == ["ground", "0.1", "M", "2.00", "1.50", "-25%", "*"]
    assert run("b" * 40, "2026-01-04", changed=True, ground=3.06)[1].split()[-2:] == ["1.53", "+2%"]
    kept = {path.name for path in (tmp_path / "history").iterdir()}
    assert kept == {f"times-{name}.json" for name in ("a" * 40, "b" * 40, "b" * 40 + "-changed")}


def test_the_first_times_of_a_checkout_are_compared_with_the_published_ones(tmp_path):
    def written(name, commit, date, **seconds):
        content = {"table": "times", "commit": commit * 40, "changed": False, "date": date, "rows": times(**seconds)}
        path = tmp_path / name
        path.write_text(json.dumps(content), encoding="utf-8")
        return path

    published = written("published.json", "a", "2026-01-01", ground=4.0)
    first = history.keep_copy(written("times.json", "b", "2026-01-02", ground=3.0))
    assert history.sentences(first, published)[1].split()[-3:-1] == ["1.50", "-25%"]
    second = history.keep_copy(written("times.json", "c", "2026-01-03", ground=6.0))
    assert history.sentences(second, published)[1].split()[-3:-1] == ["3.00", "+100%"]


def test_the_simulation_of_a_survey_agrees_with_what_is_known_without_it():
    alike = [Job(read=0.0, seconds=10.0, written=0.0)] * 40
    assert simulate(alike, 1, 1.0) == (400.0, 0.0)
    assert simulate(alike, 8, 1.0) == (50.0, 0.0)
    # The last of 41 jobs has seven cores idle.
    assert simulate([*alike, alike[0]], 8, 1.0)[0] == 60.0
    # One core waits for each of its bytes; many wait for all bytes.
    moving = [Job(read=30.0, seconds=1.0, written=20.0)] * 40
    assert simulate(moving, 1, 10.0) == (pytest.approx(40 * (1 + 5)), pytest.approx(5 / 6))
    seconds, busy = simulate(moving, 200, 10.0)
    assert seconds == pytest.approx(40 * 5, rel=0.01)
    assert busy == pytest.approx(1.0, abs=0.01)


def test_worth_finds_constants_by_imports_and_moves_them_for_a_while():
    constants = {where: value for where, value, _ in worth.constants()}
    assert "terrain.free_standing:FREE" in constants
    assert "models3d.roof_planes:_RULES" not in constants
    rule = next(rule for rule in worth.rules() if rule.name == "terrain.free_standing:FREE.step +20 %")
    assert rule.first_step(worth.STEPS) == worth.STEPS.index("ground")
    before = free_standing.FREE.step
    with rule.applied():
        assert free_standing.FREE.step == pytest.approx(1.2 * before)
    assert free_standing.FREE.step == before


def test_constants_that_decide_on_buildings_do_not_grow_in_number():
    """A new one takes the place of another: the number is only ever made smaller here."""
    assert len(worth.constants()) <= MOST_CONSTANTS


def test_every_whole_rule_of_worth_names_what_there_is():
    assert worth.WHOLE
    for rule in worth.WHOLE:
        # A name that is gone raises here.
        with rule.applied():
            pass
