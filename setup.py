"""What pyproject.toml can't say: this folder is the package ``lidar_buildings``, and metadata.txt has its version."""

import configparser

from setuptools import find_packages, setup

metadata = configparser.ConfigParser()
metadata.read("metadata.txt", encoding="utf-8")

setup(
    version=metadata["general"]["version"],
    package_dir={"lidar_buildings": "."},
    packages=[f"lidar_buildings.{room}" for room in find_packages(include=["algorithms*"])],
    package_data={"lidar_buildings.algorithms.export": ["page.html"]},
)
