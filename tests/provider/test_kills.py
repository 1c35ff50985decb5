"""Runs that are killed while they replace older outputs, in short (tests/attacks/kills.py does so for longer)."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[1] / "attacks" / "kills.py"


@pytest.mark.skipif(sys.platform != "linux", reason="runs are forked, and killed as Linux does it")
def test_a_killed_run_leaves_old_or_new_outputs_and_the_next_one_clears_up(tmp_path):
    command = [sys.executable, SCRIPT, "--kills", "3", "--kinds", "LAZ", "cloud and layer", "--output", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = json.loads((tmp_path / "kills.json").read_text())["rows"]
    assert [row["kills"] for row in rows] == [3, 3]
    assert all(row["wrong"] == row["left over"] == 0 for row in rows)
