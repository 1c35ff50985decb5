"""Profiles of QGIS for its command line, each in a folder of its own."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
from pathlib import Path

QGIS_PROCESS = shutil.which("qgis_process", path="/usr/bin:/bin") or shutil.which("qgis_process")
PLUGIN = Path(__file__).resolve().parents[1]


class Profile:
    """A profile of QGIS with the plugin enabled, in a folder of its own."""

    def __init__(self, folder: Path, packages: tuple[str, ...]) -> None:
        self.folder = folder
        profile = folder / "config" / "profiles" / "default"
        (profile / "QGIS").mkdir(parents=True)
        (profile / "QGIS" / "QGIS3.ini").write_text("[PythonPlugins]\nlidar_buildings=true\n")
        (profile / "python").mkdir()
        for name in packages:
            spec = importlib.util.find_spec(name)
            if spec is not None:
                (profile / "python" / name).symlink_to(Path(spec.origin).parent)
        (folder / "plugins").mkdir()
        (folder / "plugins" / "lidar_buildings").symlink_to(PLUGIN)
        (folder / "run").mkdir(mode=0o700)

    def __call__(self, *arguments: str, stdin: str = "") -> subprocess.CompletedProcess:
        """Run ``qgis_process``."""
        environment = {
            # A Python of another installation on the path would give QGIS a wrong prefix.
            "PATH": "/usr/bin:/bin",
            "HOME": str(self.folder),
            "LANG": "C.UTF-8",
            "QT_QPA_PLATFORM": "offscreen",
            "XDG_RUNTIME_DIR": str(self.folder / "run"),
            "QGIS_CUSTOM_CONFIG_PATH": str(self.folder / "config"),
            "QGIS_PLUGINPATH": str(self.folder / "plugins"),
        }
        return subprocess.run(
            [QGIS_PROCESS, *arguments],
            env=environment,
            input=stdin,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
