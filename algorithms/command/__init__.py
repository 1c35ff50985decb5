"""The command ``lidar-buildings``: what QGIS's toolbox has, without QGIS, made from the same declarations."""
