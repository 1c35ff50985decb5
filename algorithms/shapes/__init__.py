"""Planes, cylinders, spheres and trees: parts of a cloud, as shapes with measures."""
