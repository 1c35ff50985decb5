"""Exported files pass the official validators, where Node.js finds them: ``npm install gltf-validator``."""

import json
import shutil
import subprocess

import numpy as np
import pytest

from lidar_buildings.algorithms.export.export_models import export_models, glb_pieces
from lidar_buildings.algorithms.stage import LayerFeatures, MapFrame

SCRIPT = """
const validator = require('gltf-validator');
const raw = new Uint8Array(require('fs').readFileSync(process.argv[1]));
validator.validateBytes(raw).then(found => console.log(JSON.stringify(found.issues)));
"""


def node(*arguments):
    return subprocess.run(["node", *arguments], capture_output=True, text=True, check=False)


def test_glb_passes_the_validator_of_khronos(tmp_path):
    if shutil.which("node") is None or node("-e", "require('gltf-validator')").returncode:
        pytest.skip("Node.js finds no gltf-validator (NODE_PATH)")
    x, y = np.array([0, 4, 4, 0, 0]), np.array([0, 0, 5, 5, 0])
    roof = LayerFeatures([[np.column_stack([x, y, 3.0 + 0.5 * x])]], {"building": ["Rathaus Größe"], "slope": [26.6]})
    path = tmp_path / "models.glb"
    path.write_bytes(b"".join(glb_pieces(export_models(roofs=roof)[0], "GLB", MapFrame(np.asarray, "EPSG:25832"))))
    issues = json.loads(node("-e", SCRIPT, str(path)).stdout)
    assert issues["numErrors"] == issues["numWarnings"] == 0, issues["messages"]
