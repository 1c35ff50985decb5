"""What a user gives an algorithm, as its other modules ask for it."""

import json
from dataclasses import dataclass
from typing import Any

from qgis.core import QgsProcessingAlgorithm, QgsProcessingContext

# Values of an optional parameter that is not given: None where it is left out, "" where the command line gives none.
_NOTHING = (None, "")


@dataclass(frozen=True)
class Given:
    """The parameters of a run, with what QGIS reads them by."""

    algorithm: QgsProcessingAlgorithm  #: Declares them
    parameters: dict
    context: QgsProcessingContext

    def has(self, name: str) -> bool:
        """Whether an input is given, or an output is wanted."""
        return self.parameters.get(name) not in _NOTHING

    def read(self, kind: str, name: str, *more: Any) -> Any:
        """Return a parameter as QGIS reads it, as an "Extent" say: with what its method for that asks for besides."""
        return getattr(self.algorithm, f"parameterAs{kind}")(self.parameters, name, self.context, *more)

    def as_text(self) -> str:
        """Return the algorithm and its parameters but outputs, as JSON."""
        values = self.algorithm.asMap(self.parameters, self.context)["inputs"]
        outputs = {one.name() for one in self.algorithm.destinationParameterDefinitions()}
        inputs = {name: one for name, one in values.items() if name not in outputs}
        return json.dumps([self.algorithm.id(), inputs], default=str)

    def title(self, name: str) -> str:
        """Return the name of a parameter in the dialog."""
        return self.algorithm.parameterDefinition(name).description()
