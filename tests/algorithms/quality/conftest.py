"""The independent scorer that the measures are held to, where it is there."""

import importlib.util
import warnings
from pathlib import Path

import pytest

SCORER = Path(__file__).parents[4] / "shared" / "tools" / "score.py"


@pytest.fixture(scope="session")
def scorer():
    """Module with ``score_buildings`` and ``score_ground``."""
    if not SCORER.exists():
        pytest.skip(f"No scorer at {SCORER}")
    spec = importlib.util.spec_from_file_location("independent_scorer", SCORER)
    module = importlib.util.module_from_spec(spec)
    with warnings.catch_warnings():
        # It imports laspy, whose optional packages may grumble about the machine.
        warnings.simplefilter("ignore")
        spec.loader.exec_module(module)
    return module
