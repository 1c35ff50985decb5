"""Planes, cylinders, spheres and trees: what a cloud consists of, as shapes with measures."""
