"""The stages, in pipeline order. To add one: write its module, name it here, test it."""

from __future__ import annotations

_FUNCTIONS: tuple = ()

STAGES = {function.stage.name: function.stage for function in _FUNCTIONS}
