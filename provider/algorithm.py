"""What all algorithms of the provider do alike: checks before a run, and coordinate reference systems that last."""

from __future__ import annotations

from collections.abc import Iterable

from qgis.core import QgsProcessingContext, QgsProcessingFeedback

from .declared import DeclaredAlgorithm
from .dependencies import missing_sentence
from .errors import as_processing_errors, sentence_of
from .options import apply_options
from .qgis_crs import make_in_main_thread, renew_in_main_thread


class CheckedAlgorithm(DeclaredAlgorithm):
    """An algorithm that refuses what it can before it runs, in the words that the run would use.

    Subclasses implement :meth:`check`; their second base is QGIS's own class.
    """

    def check(self, parameters: dict, context: QgsProcessingContext) -> None:
        """Find out what a run needs; refuse with a ValueError what can be refused before it."""
        raise NotImplementedError

    def systems(self) -> Iterable[str]:
        """Return the coordinate reference systems (codes or WKT) that a checked run needs."""
        raise NotImplementedError

    def completed(self, parameters: dict) -> dict:
        """Return parameters as QGIS is to see them."""
        return parameters

    def canExecute(self) -> tuple[bool, str]:  # noqa: N802 - QGIS asks for these names
        """Whether the packages that it uses are there, and how to install what is missing."""
        missing = missing_sentence(self.declared.needed_packages)
        return (False, missing) if missing else super().canExecute()  # type: ignore[misc]

    def checkParameterValues(self, parameters: dict, context: QgsProcessingContext) -> tuple[bool, str]:  # noqa: N802
        """Refuse what can be refused before the run, in the words that the run would use."""
        try:
            self._checked(parameters, context)
        except ValueError as error:
            return False, str(error)
        except OSError as error:
            return False, sentence_of(error)
        return super().checkParameterValues(self.completed(parameters), context)  # type: ignore[misc]

    def prepareAlgorithm(  # noqa: N802
        self, parameters: dict, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> bool:
        """Find out files and values; layers may be asked only here, in the main thread.

        Models and scripts come here without :meth:`checkParameterValues`, so everything is checked again.
        """
        with as_processing_errors():
            self._checked(parameters, context)
            # Those made last while something refers to them.
            self._made = make_in_main_thread(self.systems())
        return super().prepareAlgorithm(self.completed(parameters), context, feedback)  # type: ignore[misc]

    def postProcessAlgorithm(  # noqa: N802
        self, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict:
        """Make the CRS of results last."""
        renew_in_main_thread(context.temporaryLayerStore().mapLayers().values())
        return {}

    def _checked(self, parameters: dict, context: QgsProcessingContext) -> None:
        missing = missing_sentence(self.declared.needed_packages)
        if missing:
            raise ValueError(missing)
        apply_options()
        self.check(parameters, context)
