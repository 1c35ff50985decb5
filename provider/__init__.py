"""The only folder that knows QGIS: it turns every stage and pipeline into a Processing algorithm."""
