"""Versions that are installed, in text to copy, and the installation of packages that are missing."""

import importlib
import platform
import sys
from pathlib import Path
from typing import Any, Callable, Optional

from qgis.core import Qgis, QgsApplication
from qgis.PyQt import QtWidgets
from qgis.PyQt.QtCore import QProcess, QProcessEnvironment, Qt

from ..algorithms import packages
from ..algorithms.cloud.header import SOFTWARE
from ..algorithms.package_versions import forget_versions, installed_version, too_old
from . import PROVIDER_ID
from .dependencies import lacking_sentence, package_folder, pip_arguments, python, shown_command, system_command
from .paths import PLUGIN
from .questions import is_answered_yes, push_with_button
from .run_log import plugin_version

_VERSIONS = ("numpy", *packages.REQUIRED.values(), "lazrs")
_OPTIONAL = ("laszip", "distributed")


def installation_text() -> str:
    """Return versions and folders, one a line, and the missing packages."""
    lines = [
        f"{SOFTWARE} {plugin_version()}",
        f"QGIS {Qgis.version()}",
        f"Python {platform.python_version()} ({python()})",
        f"System {platform.platform()}",
        *(f"{name} {installed_version(name) or 'is not installed'}" for name in _VERSIONS),
        *(f"{name} {installed_version(name) or 'is not installed'} (optional)" for name in _OPTIONAL),
        f"Folder for packages {package_folder()}",
        f"Folder of the plugin {PLUGIN}",
    ]
    return "\n".join([*lines, "", lacking_sentence(packages.REQUIRED.values()) or "Everything is installed."])


def show_installation(iface: Any) -> None:
    """Show the installed versions, and offer to install missing packages."""
    InstallationDialog(iface.mainWindow()).exec()


class InstallationDialog(QtWidgets.QDialog):
    """Versions in text to copy, a button that copies them, and one that installs what is missing."""

    def __init__(self, parent: Optional[QtWidgets.QWidget]) -> None:
        super().__init__(parent)
        self.setWindowTitle("LiDAR Buildings: installation")
        self.resize(720, 420)
        self.text = QtWidgets.QPlainTextEdit(installation_text())
        self.text.setReadOnly(True)
        buttons = QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        copy = QtWidgets.QPushButton("Copy")
        copy.clicked.connect(lambda: QtWidgets.QApplication.clipboard().setText(self.text.toPlainText()))
        buttons.addButton(copy, QtWidgets.QDialogButtonBox.ButtonRole.ActionRole)
        self.install = QtWidgets.QPushButton("Install…")
        self.install.clicked.connect(self._install)
        buttons.addButton(self.install, QtWidgets.QDialogButtonBox.ButtonRole.ActionRole)
        self.install.setVisible(bool(packages.absent()))
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(QtWidgets.QLabel("Add this text to a report of a problem."))
        layout.addWidget(self.text)
        layout.addWidget(buttons)

    def _install(self) -> None:
        install_missing(self)
        self.text.setPlainText(installation_text())
        self.install.setVisible(bool(packages.absent()))


def install_missing(parent: Optional[QtWidgets.QWidget], ask: Optional[Callable[[str], bool]] = None) -> bool:
    """Install the packages that are missing, after the user has seen the command; return whether all are there."""
    absent = packages.absent()
    by_system = system_command(absent)
    if by_system:
        what = "Packages of the system have to be installed in a terminal, then QGIS be started again"
        QtWidgets.QMessageBox.information(parent, SOFTWARE, f"{what}:\n\n{by_system}")
        return False
    if not absent or not (ask or (lambda command: _is_wanted(parent, command)))(shown_command(absent)):
        return not absent
    replaces_loaded = any(too_old(name) and name in sys.modules for name in absent)
    output = _run(parent, python(), pip_arguments(absent))
    _find_new_packages()
    remaining = packages.absent()
    if remaining:
        reason = output.strip().splitlines()[-1] if output.strip() else "the command gave no reason"
        QtWidgets.QMessageBox.warning(parent, SOFTWARE, f"Not installed: {', '.join(remaining)}. Python says: {reason}")
    else:
        what = "start QGIS again" if replaces_loaded else "the algorithms can run"
        QtWidgets.QMessageBox.information(parent, SOFTWARE, f"Everything is installed; {what}.")
    return not remaining


def _is_wanted(parent: Optional[QtWidgets.QWidget], command: str) -> bool:
    question = "Run this command? It installs Python packages for QGIS alone, from the Python Package Index."
    return is_answered_yes(parent, SOFTWARE, f"{question}\n\n{command}")


def _run(parent: Optional[QtWidgets.QWidget], program: str, arguments: list[str]) -> str:
    """Run a program while a window shows that it is at work; return its output, or the reason why it did not start."""
    waiting = QtWidgets.QProgressDialog("Installing Python packages…", "Cancel", 0, 0, parent)
    waiting.setWindowTitle(SOFTWARE)
    waiting.setWindowModality(Qt.WindowModality.WindowModal)
    waiting.setMinimumDuration(0)
    process = QProcess(waiting)
    environment = QProcessEnvironment.systemEnvironment()
    # QGIS sets it for its own Python; another interpreter would look for its modules there.
    environment.remove("PYTHONHOME")
    process.setProcessEnvironment(environment)
    process.setProcessChannelMode(QProcess.ProcessChannelMode.MergedChannels)
    process.finished.connect(lambda *_: waiting.reset())
    waiting.canceled.connect(process.kill)
    process.start(program, arguments)
    if not process.waitForStarted():
        return process.errorString()
    waiting.exec()
    process.waitForFinished()
    return bytes(process.readAll()).decode(errors="replace")


def _find_new_packages() -> None:
    """Have this Python find what was installed while it runs."""
    folder = str(package_folder())
    if Path(folder).is_dir() and folder not in sys.path:
        sys.path.append(folder)
    importlib.invalidate_caches()
    forget_versions()


def warn_at_start(iface: Any) -> Callable[[], None]:
    """Show a message with a button where the algorithms can't run; return what takes it away again."""
    missing = packages.missing(packages.ESSENTIAL)
    if not missing:
        return lambda: None
    text = f"Python packages are missing or too old: {', '.join(missing)}."
    level = Qgis.MessageLevel.Warning
    return push_with_button(iface, SOFTWARE, text, "Install…", lambda: _installed(iface.mainWindow()), level)


def _installed(parent: Optional[QtWidgets.QWidget]) -> bool:
    """Install what is missing; return whether all is there, and have the toolbox ask then which algorithms can run."""
    is_complete = install_missing(parent)
    provider = QgsApplication.processingRegistry().providerById(PROVIDER_ID)
    if is_complete and provider is not None:
        provider.refreshAlgorithms()
    return is_complete
