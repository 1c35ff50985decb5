"""LiDAR Buildings: a QGIS Processing plugin that finds buildings in point clouds."""


def classFactory(iface):  # noqa: N802 - QGIS asks for this name
    """Return the plugin; imported here, so that the numpy functions load without QGIS."""
    from .provider.plugin import Plugin

    return Plugin(iface)
