"""Reads GLB files back by the letter of the specification, for tests of what writes them."""

import json
import struct

import numpy as np

DTYPES = {5126: "<f4", 5125: "<u4"}
PROPERTY_DTYPES = {"INT32": "<i4", "FLOAT64": "<f8"}


class Glb:
    """The content of a file: its root, and arrays of its accessors and properties."""

    def __init__(self, raw):
        magic, version, length = struct.unpack_from("<4sII", raw)
        assert (magic, version, length) == (b"glTF", 2, len(raw))
        size, kind = struct.unpack_from("<I4s", raw, 12)
        assert kind == b"JSON"
        assert size % 4 == 0
        self.root = json.loads(raw[20 : 20 + size])
        rest, kind = struct.unpack_from("<I4s", raw, 20 + size)
        assert kind == b"BIN\0"
        assert 28 + size + rest == len(raw)
        self.binary = raw[28 + size :]

    def view(self, number):
        view = self.root["bufferViews"][number]
        return self.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]

    def accessor(self, number):
        one = self.root["accessors"][number]
        values = np.frombuffer(self.view(one["bufferView"]), DTYPES[one["componentType"]])
        values = values.reshape((one["count"], int(one["type"][3:])) if one["type"] != "SCALAR" else one["count"])
        np.testing.assert_array_equal(values.reshape(one["count"], -1).min(axis=0), one["min"])
        np.testing.assert_array_equal(values.reshape(one["count"], -1).max(axis=0), one["max"])
        return values

    def triangles(self):
        """Return positions (n, 3, 3) in east, north and up, normals, building, face and material of all triangles."""
        parts = []
        shift = np.array(self.root["nodes"][0]["translation"])
        for primitive in self.root["meshes"][0]["primitives"]:
            corners = self.accessor(primitive["indices"]).reshape(-1, 3)
            arrays = {name: self.accessor(number) for name, number in primitive["attributes"].items()}
            positions = (arrays["POSITION"].astype(float) + shift)[corners]
            ids = [arrays[f"_FEATURE_ID_{set_}"][corners] for set_ in (0, 1)]
            assert all((one == one[:, :1]).all() for one in ids)
            for described, one in zip(primitive["extensions"]["EXT_mesh_features"]["featureIds"], ids):
                assert described["featureCount"] == len(np.unique(one))
            material = np.full(len(corners), primitive["material"])
            normals = arrays["NORMAL"][corners]
            parts.append((positions @ Y_UP, normals @ Y_UP, *(one[:, 0].astype(int) for one in ids), material))
        return [np.concatenate(column) for column in zip(*parts)]

    def table(self, number):
        """Return the columns of a property table by the names of their attributes, None where there is no value."""
        metadata = self.root["extensions"]["EXT_structural_metadata"]
        table = metadata["propertyTables"][number]
        columns = {}
        for called, stored in table["properties"].items():
            described = metadata["schema"]["classes"][table["class"]]["properties"][called]
            if described["type"] == "STRING":
                ends = np.frombuffer(self.view(stored["stringOffsets"]), "<u4")
                raw = self.view(stored["values"])
                values = [raw[start:end].decode() for start, end in zip(ends, ends[1:])]
            else:
                values = np.frombuffer(
                    self.view(stored["values"]), PROPERTY_DTYPES[described["componentType"]]
                ).tolist()
            assert len(values) == table["count"]
            columns[described["name"]] = [None if value == described["noData"] else value for value in values]
        return columns


# Turns rows of right, up and towards the viewer into rows of east, north and up.
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
