"""The attacks in short: those that run for minutes or hours are in the folder of that name."""

from __future__ import annotations

import subprocess
import sys
from itertools import count
from pathlib import Path

import pytest

from lidar_buildings.tests.attacks import fuzz
from lidar_buildings.tests.attacks.mutants import KINDS, mutant

FOLDER = Path(__file__).resolve().parent / "attacks"
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="memory is measured and limited as Linux does it")


def test_a_mutant_can_be_made_again():
    for number in range(3 * len(KINDS)):
        assert mutant(5, number) == mutant(5, number)
        assert mutant(5, number) != mutant(6, number)


@LINUX
def test_no_damage_brings_about_more_than_a_sentence():
    result = fuzz.attack(1, iter(range(15 * len(KINDS))))
    assert [finding["said"] for finding in result.findings] == []
    assert result.mutants == 15 * len(KINDS)
    assert {outcome for _, outcome in result.counts} == {"read", "refused"}


VICTIM = """
import ctypes, json, sys
for number in map(int, sys.stdin):
    if number == 1:
        ctypes.string_at(0)
    while number == 2:
        pass
    memory = 1000.0 if number == 3 else 50.0
    print(json.dumps({"number": number, "kind": "las", "outcome": "read", "said": "", "memory": memory}), flush=True)
"""


@LINUX
def test_processes_that_end_or_hang_or_take_much_memory_are_found(tmp_path, monkeypatch, capsys):
    (tmp_path / "victim.py").write_text(VICTIM)
    monkeypatch.setattr(fuzz, "HERE", tmp_path)
    monkeypatch.setattr(fuzz, "MOST_TIME", 1.0)
    monkeypatch.setattr(fuzz, "_START", 60.0)
    # The second is given to a process that has answered: one that has just begun may take long.
    result = fuzz.attack(1, iter((0, 5, 2, 1, 3, 4)), workers=2)
    assert result.mutants == 6
    said = {finding["number"]: finding["said"] for finding in result.findings}
    assert sorted(said) == [1, 2, 3]
    assert "the process ended with -11" in said[1]
    assert "no answer within" in said[2]
    assert "1000 MB of memory" in said[3]
    fuzz.show(result, tmp_path / "findings")
    assert "6 mutants, at most 1000 MB (number 3)" in capsys.readouterr().out
    (place,) = (tmp_path / "findings").glob("1-2-*")
    assert "fuzz.py --seed 1 --only 2 --kinds las laz" in (place / "said.txt").read_text()
    assert len(list(place.iterdir())) == 1 + len(mutant(1, 2).files)


@LINUX
def test_time_ends_a_search():
    assert fuzz.attack(1, count(), minutes=0).mutants == 1


def test_the_command_line(tmp_path):
    command = [sys.executable, FOLDER / "fuzz.py", "--seed", "1", "--only", "3", "--findings", tmp_path / "found"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "1 mutants, at most" in done.stdout
    assert not (tmp_path / "found").exists()
