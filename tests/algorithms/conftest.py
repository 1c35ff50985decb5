"""What the tests of the core share."""

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

# A busy machine is no failure, and the same examples in every run make a failure one that can be repeated.
settings.register_profile("repeatable", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("repeatable")


@pytest.fixture
def rng():
    """Random numbers that are the same in every run."""
    return np.random.default_rng(20190613)
