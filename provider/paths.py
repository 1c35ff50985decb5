"""Where the plugin keeps its own files."""

from pathlib import Path

PLUGIN = Path(__file__).resolve().parent.parent
RESOURCES = PLUGIN / "resources"
ICON = RESOURCES / "icons" / "lidar_buildings.svg"
GROUP_ICONS = RESOURCES / "icons" / "groups"
STYLES = RESOURCES / "styles"
PICTURES = RESOURCES / "help" / "pictures"
