"""Who runs an algorithm: the command line, a chain, or a dialog."""

from qgis.core import QgsApplication, QgsProcessingFeedback


def on_command_line() -> bool:
    """Whether this is ``qgis_process``, which shows HTML as it is written."""
    return QgsApplication.platform() == "qgis_process"


def is_step(feedback: QgsProcessingFeedback) -> bool:
    """Whether a feedback belongs to a step of a chain."""
    # By its Qt class: QGIS hands it to Python as a plain feedback.
    return feedback.inherits("QgsProcessingMultiStepFeedback")
