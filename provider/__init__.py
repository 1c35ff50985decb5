"""The only folder that imports QGIS: it turns every stage and pipeline into a Processing algorithm."""

# Prefix of all algorithm ids; frozen, saved models depend on it.
PROVIDER_ID = "lidarbuildings"

# The algorithm that finds buildings.
DETECT = f"{PROVIDER_ID}:detectbuildings"

# Name of the window of the review, by which it is found again.
REVIEW_WINDOW = "LidarBuildingsReview"
