#!/usr/bin/env python3
"""Read damaged point clouds until time is up, and keep those that the readers do not bear: ``fuzz.py --minutes 5``.

A file may be read, or refused with one sentence (ValueError). All else is a finding: any other exception, more than
600 MB, more than 10 s of processor time, a process that ended, a written file that differs from what was read. Each
finding is kept with its files and a line that repeats it; the exit code is 1 then.
"""

from __future__ import annotations

import argparse
import collections
import json
import os
import re
import selectors
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import conftest  # noqa: E402, F401 - registers the checkout as the package lidar_buildings
from lidar_buildings.tests.attacks.mutants import KINDS, mutant  # noqa: E402

HERE = Path(__file__).resolve().parent
FINDINGS = HERE.parents[1] / "benchmarks" / "fuzz"
# What reading a file of some kB may take.
MOST_MEMORY = 600.0  # MB
MOST_TIME = 10.0  # s
# Address space beyond a process at rest (MB): an allocation that is refused shows what a file asked for.
ADDRESS_SPACE = 1500.0
# Longest time of an answer, also of a process that starts on a loaded machine or waits without working.
_START = 120.0  # s
# Threads of lazrs and arenas of the C library take address space by the number of cores.
_ENVIRONMENT = {
    "RAYON_NUM_THREADS": "2",
    "OPENBLAS_NUM_THREADS": "1",
    "MALLOC_ARENA_MAX": "2",
    "PYTHONFAULTHANDLER": "",
}
# Bytes of the end of an error stream that are kept.
_TAIL = 2000


@dataclass
class Result:
    """The results of a run: outcomes by kind, findings, and the most memory (MB) and time (s) with their mutants."""

    counts: collections.Counter = field(default_factory=collections.Counter)
    findings: list[dict[str, Any]] = field(default_factory=list)
    memory: tuple[float, int] = (0.0, 0)
    seconds: tuple[float, int] = (0.0, 0)

    @property
    def mutants(self) -> int:
        """How many were read."""
        return sum(self.counts.values())


class Victim:
    """A process that reads one mutant after the other."""

    def __init__(self, seed: int, kinds: tuple[str, ...], selector: selectors.BaseSelector) -> None:
        self._command = [sys.executable, str(HERE / "victim.py"), str(seed), str(ADDRESS_SPACE), *kinds]
        self._selector, self.number, self.since, self._before, self._is_new = selector, -1, 0.0, 0.0, True
        self._start()

    def _start(self) -> None:
        self._errors = TemporaryFile()  # noqa: SIM115 - closed with the process
        self._process = subprocess.Popen(
            self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors,
            env={**os.environ, **_ENVIRONMENT}, bufsize=0,
        )  # fmt: skip
        self._selector.register(self._process.stdout, selectors.EVENT_READ, self)
        self._is_new = True

    def give(self, number: int) -> None:
        """Have a mutant read."""
        self.number, self.since, self._before = number, time.monotonic(), _processor_time(self._process.pid)
        # A process that has ended is found out when its answer is read.
        with suppress(BrokenPipeError):
            self._process.stdin.write(f"{number}\n".encode())

    @property
    def is_late(self) -> bool:
        """Whether it hangs: by its processor time, where that is known, as a loaded machine makes it wait."""
        waited = time.monotonic() - self.since
        return waited > _START or (not self._is_new and waited > MOST_TIME and self._worked() > MOST_TIME)

    def _worked(self) -> float:
        """Return the processor time since it was given a mutant (s)."""
        return _processor_time(self._process.pid) - self._before

    def answer(self) -> dict[str, Any]:
        """Return the answer that is there, or how the process ended; it is replaced then."""
        line = self._process.stdout.readline()
        if line:
            self._is_new = False
            return json.loads(line)
        return self.replaced(f"the process ended with {self._process.wait()}")

    def replaced(self, why: str) -> dict[str, Any]:
        """End the process, start another, and return why as an answer."""
        said = f"{why}\n{self.end()}"
        self._start()
        return {"number": self.number, "kind": "", "outcome": "fault", "said": said, "memory": 0.0}

    def end(self) -> str:
        """End the process; return the last part of its error stream."""
        self._selector.unregister(self._process.stdout)
        self._process.kill()
        self._process.wait()
        self._errors.seek(0)
        said = self._errors.read()[-_TAIL:].decode(errors="replace")
        for stream in (self._process.stdin, self._process.stdout, self._errors):
            stream.close()
        return said


def _processor_time(process: int) -> float:
    """Return the processor time of a process (s), infinity where the system does not report it."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return float("inf")
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def attack(
    seed: int, numbers: Iterator[int], kinds: tuple[str, ...] = KINDS, workers: int = 1, minutes: float = float("inf")
) -> Result:
    """Have mutants read by processes of their own until there are no more or time is up."""
    result, end, selector = Result(), time.monotonic() + 60 * minutes, selectors.DefaultSelector()
    victims = [Victim(seed, kinds, selector) for _ in range(workers)]
    busy = {victim for victim in victims if _given(victim, numbers)}
    while busy:
        ready = {key.data for key, _ in selector.select(1.0)} & busy
        for victim in list(busy):
            if victim not in ready and not victim.is_late:
                continue
            seconds = time.monotonic() - victim.since
            late = f"no answer within {seconds:.0f} s"
            _note(result, victim.answer() if victim in ready else victim.replaced(late), seconds, seed, kinds)
            if time.monotonic() > end or not _given(victim, numbers):
                busy.remove(victim)
    for victim in victims:
        victim.end()
    selector.close()
    return result


def _given(victim: Victim, numbers: Iterator[int]) -> bool:
    number = next(numbers, None)
    if number is not None:
        victim.give(number)
    return number is not None


def _note(result: Result, answer: dict[str, Any], seconds: float, seed: int, kinds: tuple[str, ...]) -> None:
    kind = answer["kind"] or kinds[answer["number"] % len(kinds)]
    if answer["memory"] > MOST_MEMORY:
        answer.update(outcome="fault", said=f"{answer['memory']:.0f} MB of memory; {answer['said']}")
    result.counts[kind, answer["outcome"]] += 1
    result.memory = max(result.memory, (answer["memory"], answer["number"]))
    result.seconds = max(result.seconds, (seconds, answer["number"]))
    if answer["outcome"] == "fault":
        result.findings.append({**answer, "kind": kind, "seed": seed, "kinds": kinds})


def keep(finding: dict[str, Any], folder: Path) -> Path:
    """Write the files of a finding and its error to a folder, and return it."""
    number, seed, kinds = finding["number"], finding["seed"], finding["kinds"]
    own = folder / f"{seed}-{number}-{finding['kind']}"
    own.mkdir(parents=True, exist_ok=True)
    for name, raw in mutant(seed, number, kinds).files.items():
        (own / name).write_bytes(raw)
    again = f"python tests/attacks/fuzz.py --seed {seed} --only {number} --kinds {' '.join(kinds)}\n"
    (own / "said.txt").write_text(f"{again}{finding['said']}\n", encoding="utf-8", errors="backslashreplace")
    return own


def cause(finding: dict[str, Any]) -> str:
    """Return the last line of an error without numbers, which is the same for findings of one cause."""
    lines = [line.strip() for line in finding["said"].splitlines() if line.strip()]
    where = [line for line in lines if line.startswith("File ") and "tests/attacks" not in line]
    position = re.sub(r'File ".*/(\w+/\w+\.py)", line (\d+).*', r"\1:\2 ", where[-1]) if where else ""
    return position + re.sub(r"\d+", "#", (lines or [""])[-1])[:160]


def show(result: Result, folder: Path) -> None:
    """Print the results of a run, and keep the findings."""
    kinds = sorted({kind for kind, _ in result.counts}, key=KINDS.index)
    for kind in kinds:
        read, refused, fault = (result.counts[kind, outcome] for outcome in ("read", "refused", "fault"))
        print(f"{kind:8} {read:8} read {refused:8} refused {fault:6} findings")
    (memory, heaviest), (seconds, slowest) = result.memory, result.seconds
    print(f"{result.mutants} mutants, at most {memory:.0f} MB (number {heaviest}) and {seconds:.1f} s ({slowest})")
    causes = collections.Counter(map(cause, result.findings))
    for finding in result.findings:
        keep(finding, folder)
    for said, count in causes.most_common():
        print(f"{count:6} x {said}")
    if result.findings:
        print(f"Findings are in {folder}.")


def main(arguments: list[str] | None = None) -> int:
    """Run as the command line says; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=5.0, help="how long (5)")
    parser.add_argument("--mutants", type=int, help="how many at most")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="of the damage (the time)")
    parser.add_argument("--start", type=int, default=0, help="number of the first mutant (0)")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of mutants")
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=KINDS, help="of files (all)")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes that read (all cores)")
    parser.add_argument("--findings", type=Path, default=FINDINGS, help="folder for what is found (benchmarks/fuzz)")
    parser.add_argument("--guided", action="store_true", help="choose damage by the lines it reaches (needs atheris)")
    asked = parser.parse_args(arguments)
    if asked.guided:
        command = [sys.executable, HERE / "guided.py", asked.findings / "guided", str(asked.minutes), str(asked.seed)]
        return subprocess.run(command, check=False).returncode
    kinds = tuple(asked.kinds) or KINDS
    stop = sys.maxsize if asked.mutants is None else asked.start + asked.mutants
    numbers = iter(asked.only if asked.only else range(asked.start, stop))
    print(f"Seed {asked.seed}, {', '.join(kinds)}")
    result = attack(asked.seed, numbers, kinds, asked.workers, asked.minutes)
    show(result, asked.findings)
    return 1 if result.findings else 0


if __name__ == "__main__":
    sys.exit(main())
