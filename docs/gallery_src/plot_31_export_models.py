"""
Models for the browser
======================

*Export models* writes GLB :cite:p:`gltf2021` for browsers and a tileset :cite:p:`tiles2023` for globes. The file is
read back here: triangles in the colors of roofs and walls, with the numbers of their buildings.
"""

import json

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.run import run_pipeline, run_stage
from lidar_buildings.algorithms.stage import MapFrame
from lidar_buildings.algorithms.stages import STAGES

town = {"size": 80.0, "density": 8.0, "buildings": 34.0, "trees": 25.0, "forest": 0.05, "river": False}
cloud = run_stage(STAGES["simulate_town"], noise_points=0.0, **town).cloud
cloud.set("classification", np.zeros(len(cloud), np.uint8))
layers = run_pipeline(PIPELINES["model_buildings"], cloud).layers
given = {name: layers[name] for name in ("buildings", "walls", "roofs")}
exported = run_stage(STAGES["export_models"], input_layers=given)

# %%
# A header of 12 bytes, then two chunks: JSON that describes the file, and the numbers.
raw = b"".join(exported.files["glb"].pieces("GLB", MapFrame(cloud.to_map, "EPSG:25832")))
length = int.from_bytes(raw[12:16], "little")
root, numbers = json.loads(raw[20 : 20 + length]), raw[28 + length :]


def values(number, dtype):
    """Return the values of an accessor."""
    view = root["bufferViews"][root["accessors"][number]["bufferView"]]
    return np.frombuffer(numbers, dtype, view["byteLength"] // 4, view["byteOffset"])


# %%
# The axis y is up. Colors are linear shares of light.
triangles, colors = [], []
for primitive in root["meshes"][0]["primitives"]:
    corners = values(primitive["attributes"]["POSITION"], "<f4").reshape(-1, 3) @ [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    triangles.extend(corners[values(primitive["indices"], "<u4").reshape(-1, 3)])
    light = root["materials"][primitive["material"]]["pbrMetallicRoughness"]["baseColorFactor"]
    colors += [np.array(light) ** (1 / 2.2)] * (len(triangles) - len(colors))

plt.style.use("dark_background")
ax = plt.figure(figsize=(8, 4.5)).add_axes((0, 0, 1, 1), projection="3d")
ax.add_collection3d(Poly3DCollection(triangles, facecolor=colors, edgecolor="black", linewidth=0.3))
(west, south, bottom), (east, north, top) = np.min(triangles, axis=(0, 1)), np.max(triangles, axis=(0, 1))
ax.set(xlim=(west, east), ylim=(south, north), zlim=(bottom, top))
ax.set_box_aspect((east - west, north - south, top - bottom), zoom=1.0)
ax.view_init(elev=35, azim=-65)
ax.set_axis_off()
