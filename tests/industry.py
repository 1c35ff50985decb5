"""Pieces of a plant whose geometry is known, for tests of shapes. Meters throughout."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lidar_buildings.algorithms.stage import LayerFeatures


def pipe(
    rng: np.random.Generator,
    radius: float,
    length: float,
    spacing: float,
    noise: float,
    axis: tuple[float, float, float],
    seen: float = 0.6,
) -> np.ndarray:
    """Return points (n, 3) on the share ``seen`` of a cylinder around zero, seen mostly from above."""
    count = round(2 * np.pi * radius * seen * length / spacing**2)
    along = np.array(axis, float) / np.linalg.norm(axis)
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    angle = np.pi * seen * rng.uniform(-1, 1, count)[:, None] - np.pi / 2
    away = np.cos(angle) * first + np.sin(angle) * second
    return (radius + rng.normal(0, noise, (count, 1))) * away + length * rng.uniform(-0.5, 0.5, (count, 1)) * along


def slab(rng: np.random.Generator, size: float, spacing: float, noise: float) -> np.ndarray:
    """Return points (n, 3) of a level square around zero."""
    count = round((size / spacing) ** 2)
    return np.column_stack([rng.uniform(-size / 2, size / 2, (count, 2)), rng.normal(0, noise, count)])


def edge(rng: np.random.Generator, size: float, spacing: float, noise: float) -> np.ndarray:
    """Return points (n, 3) of a square that is folded by 90° along its middle: an angle iron."""
    flat = slab(rng, size, spacing, noise)
    return np.where(flat[:, :1] > 0, flat, flat[:, [2, 1, 0]] * [1, 1, -1])


def bent(rng: np.random.Generator, radius: float, bend: float, spacing: float, noise: float) -> np.ndarray:
    """Return points (n, 3) of a quarter of a torus: an elbow."""
    count = round(np.pi**2 * bend * radius / spacing**2)
    turn, around = rng.uniform(0, np.pi / 2, count), rng.uniform(0, 2 * np.pi, count)
    reach = radius + rng.normal(0, noise, count)
    out = bend + reach * np.cos(around)
    return np.column_stack([out * np.cos(turn), out * np.sin(turn), reach * np.sin(around)])


@dataclass(frozen=True)
class Comparison:
    """Cylinders that were found, beside the true ones.

    Attributes
    ----------
    is_found : ndarray of shape (m,), bool
        True cylinders on which one was found with a radius within 5 % and an axis within a quarter of the radius.
    error : ndarray of shape (k,)
        Relative errors of the radii of those that were found.
    invented : list of int
        Numbers of cylinders that belong to no true one in this sense.
    """

    is_found: np.ndarray
    error: np.ndarray
    invented: list[int]


def compared(true_id: np.ndarray, true_axes: LayerFeatures, found_id: np.ndarray, axes: LayerFeatures) -> Comparison:
    """Compare cylinders with the truth.

    Parameters
    ----------
    true_id, found_id : ndarray of shape (n,)
        Numbers of the parts and of the segments of the points.
    true_axes, axes : LayerFeatures
        Axes with ``id`` and ``radius`` (m).
    """
    number_of = {number: row for row, number in enumerate(true_axes.columns["id"])}
    is_found, errors, invented = np.zeros(len(true_axes), bool), [], []
    for number, line, radius in zip(axes.columns["id"], axes.geometries, axes.columns["radius"]):
        parts, count = np.unique(true_id[found_id == number], return_counts=True)
        row = number_of.get(int(parts[np.argmax(count)])) if 2 * count.max() > count.sum() else None
        if row is None:
            invented.append(number)
            continue
        start, end = np.array(true_axes.geometries[row])
        along = (end - start) / np.linalg.norm(end - start)
        off = np.linalg.norm(np.cross(np.array(line) - start, along), axis=1).max()
        true_radius = true_axes.columns["radius"][row]
        error = abs(radius / true_radius - 1)
        if error <= 0.05 and off <= 0.25 * true_radius:
            is_found[row] = True
            errors.append(error)
        else:
            invented.append(number)
    return Comparison(is_found, np.array(errors), invented)
