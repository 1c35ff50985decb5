"""What users set for all runs, under Settings ▸ Options ▸ Processing ▸ Providers ▸ LiDAR Buildings."""

from dataclasses import dataclass
from typing import Any, Callable

from qgis.core import QgsSettings

from ..algorithms.cloud.web_addresses import allow_hosts
from ..algorithms.cloud.web_cache import keep_in
from ..algorithms.landcover.recode_classes import CODES as AGENCIES
from ..algorithms.presets import PRESETS
from ..algorithms.threads import use_threads

# The heading of the options in the dialog of QGIS.
GROUP = "LiDAR Buildings"

# Where QGIS's Processing keeps what its options dialog shows.
_KEPT_AT = "Processing/Configuration"


@dataclass(frozen=True)
class Option:
    """One setting: its name in QGIS's settings, its title in the options, and its value where nothing is set."""

    name: str
    title: str
    default: str = ""
    choices: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """Where QGIS keeps it."""
        return f"{_KEPT_AT}/{self.name}"

    @property
    def value(self) -> str:
        """What the user has set."""
        found: Any = QgsSettings().value(self.key, self.default)
        return self.default if found is None else str(found).strip()

    def set(self, value: str) -> None:
        """Keep a value, and show it in the options."""
        QgsSettings().setValue(self.key, value)
        try:
            from processing.core.ProcessingConfig import ProcessingConfig
        except ImportError:  # Another QGIS may have no class of that name.
            return
        if self.name in ProcessingConfig.settings:
            ProcessingConfig.settings[self.name].value = value


SCHEDULERS = Option("LIDARBUILDINGS_SCHEDULERS", "Dask schedulers that may be used (addresses, with spaces between)")

PRESET = Option("LIDARBUILDINGS_PRESET", "Kind of cloud that dialogs begin with", "automatic", tuple(PRESETS))
CODES = Option("LIDARBUILDINGS_CODES", "Class codes that dialogs begin with", next(iter(AGENCIES)), tuple(AGENCIES))
THREADS = Option("LIDARBUILDINGS_THREADS", "Threads (empty = one for each core)")
WEB_LIMIT = Option("LIDARBUILDINGS_WEB_LIMIT", "Most that a run reads of a point cloud on the web (MB)", "500")
WEB_HOSTS = Option("LIDARBUILDINGS_WEB_HOSTS", "Hosts that files may name point clouds of (with spaces between)")
WEB_CACHE = Option("LIDARBUILDINGS_WEB_CACHE", "Folder that keeps what runs read from the web (empty = none)")

OPTIONS = (PRESET, CODES, THREADS, WEB_LIMIT, WEB_HOSTS, WEB_CACHE, SCHEDULERS)


def apply_options() -> None:
    """Have runs use as many threads, and files name point clouds on those hosts, as the user has set.

    Raises
    ------
    ValueError
        If the setting is no number of threads.
    """
    text = THREADS.value
    if text and not (text.isdigit() and int(text)):
        raise ValueError(f"'{THREADS.title}' in the options of Processing must be a whole number from 1, got {text!r}.")
    use_threads(int(text) if text else None)
    allow_hosts(WEB_HOSTS.value.split())
    keep_in(WEB_CACHE.value)


def add_options() -> Callable[[], None]:
    """Show the settings in the options of Processing; return what takes them away again."""
    from processing.core.ProcessingConfig import ProcessingConfig, Setting

    for option in OPTIONS:
        kind = {"valuetype": Setting.SELECTION_STORE_STRING, "options": list(option.choices)} if option.choices else {}
        setting = Setting(GROUP, option.name, option.title, option.default, **kind)
        setting.read()
        ProcessingConfig.addSetting(setting)

    def remove() -> None:
        for option in OPTIONS:
            ProcessingConfig.removeSetting(option.name)

    return remove
