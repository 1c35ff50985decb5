"""The only folder that imports QGIS: it turns every stage and pipeline into a Processing algorithm."""

# Prefix of all algorithm ids; frozen, saved models depend on it.
PROVIDER_ID = "lidarbuildings"
