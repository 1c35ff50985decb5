"""Tracings of houses drawn as a grid of labels."""

import numpy as np

from lidar_buildings.algorithms.footprints.alpha_shape import trace_outlines


def grid(label, step=1.0):
    """Return a tracing of points on a grid with a label each, whose rows go north."""
    rows, columns = np.shape(label)
    x, y = np.meshgrid(step * np.arange(columns), step * np.arange(rows))
    # Off the grid by a little, so that no four points lie on a circle.
    wiggle = 0.02 * np.random.default_rng(5).uniform(-1, 1, (rows * columns, 2))
    return trace_outlines(np.column_stack([x.ravel(), y.ravel()]) + wiggle, np.ravel(label), step, 1.6 * step)


def side_by_side(*widths, height=5):
    return np.repeat(np.repeat(np.arange(1, len(widths) + 1), widths)[None], height, axis=0)
