"""Cylinders and spheres fitted to points by least squares, and how well these support them."""

from dataclasses import dataclass

import numpy as np

from ..geometry.polygons import axes_across

# Rounds of Gauss and Newton: from a start within a few percent they converge in three to five.
_ROUNDS = 8

# Patterns are linearly dependent if an eigenvalue of their products is below this share of the largest.
_LEAST_PRODUCT = 1e-12

# Fewest points of a seed, a stem or a piece of a branch to which a cylinder or a sphere is fitted: three times the five
# unknowns and one more.
LEAST_POINTS = 16

# Number of sectors of the circumference that are seen or not: 10° each.
SECTORS = 36


@dataclass(frozen=True)
class Cylinder:
    """An endless cylinder: a point of its axis (3,), the direction of the axis (3,), upward, and the radius, m."""

    center: np.ndarray
    axis: np.ndarray
    radius: float

    def local(self, xyz: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the position along the axis, the distance from it (m), and the directions away from it (n, 3)."""
        offset = xyz - self.center
        along = offset @ self.axis
        offset -= along[:, None] * self.axis
        distance = np.sqrt(np.einsum("ij,ij->i", offset, offset))
        offset /= np.maximum(distance, 1e-12)[:, None]
        return along, distance, offset

    def angle(self, away: np.ndarray) -> np.ndarray:
        """Return the angle (n,) around the axis, radians, of directions away from it (n, 3)."""
        first, second = axes_across(self.axis)
        return np.arctan2(away @ second, away @ first)


def upward(axis: np.ndarray) -> np.ndarray:
    """Return the axis turned so that its last component that is not zero is positive."""
    for component in axis[::-1]:
        if abs(component) > 1e-9:
            return axis if component > 0 else -axis
    return axis


def fit_cylinder(xyz: np.ndarray, start: Cylinder, rounds: int = _ROUNDS) -> Cylinder:
    """Return the cylinder with the least sum of squared distances of points (n, 3), n >= 6, from it.

    Without a solution, or where the radius changes by more than itself, it is ``start``.
    """
    cylinder = start
    # The distance falls as the axis moves or leans toward the point, and as the radius grows.
    design = np.ones((5, len(xyz)))
    for _ in range(rounds):
        first, second = axes_across(cylinder.axis)
        a, b, along = np.array([first, second, cylinder.axis]) @ (xyz - cylinder.center).T
        middle = along.sum() / len(along)
        along -= middle
        distance = np.sqrt(a * a + b * b)
        design[:2] = (a, b) / np.maximum(distance, 1e-12)
        np.multiply(design[:2], along, out=design[2:4])
        step = _solved(design, distance - cylinder.radius)
        if not np.isfinite(step).all() or abs(step[4]) > cylinder.radius:
            return start
        axis = cylinder.axis + step[2] * first + step[3] * second
        center = cylinder.center + cylinder.axis * middle + step[0] * first + step[1] * second
        cylinder = Cylinder(center, axis / np.sqrt(axis @ axis), cylinder.radius + float(step[4]))
        if np.abs(step).max() < 1e-7:
            break
    return Cylinder(cylinder.center, upward(cylinder.axis), cylinder.radius)


def _solved(design: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the least-squares solution (k,) of a design (k, n), NaN where undefined."""
    product = design @ design.T
    # Scaled, so that the solution stays precise where patterns differ in size.
    scale = np.maximum(np.sqrt(product.diagonal()), 1e-150)
    try:
        return np.linalg.solve(product / (scale * scale[:, None]), (design @ values) / scale) / scale
    except np.linalg.LinAlgError:
        return np.full(len(scale), np.nan)


def fit_sphere(xyz: np.ndarray, center: np.ndarray, radius: float) -> tuple[np.ndarray, float]:
    """Return center (3,) and radius of the sphere with the least sum of squared distances of points (n, 3), n >= 5.

    Without a solution, or where the radius changes by more than itself, they are those given.
    """
    at, size = center, radius
    for _ in range(_ROUNDS):
        offset = xyz - at
        distance = np.linalg.norm(offset, axis=1)
        design = np.vstack([offset.T / np.maximum(distance, 1e-12), np.ones(len(xyz))])
        step = _solved(design, distance - size)
        if not np.isfinite(step).all() or abs(step[3]) > size:
            return center, radius
        at, size = at + step[:3], size + float(step[3])
        if np.abs(step).max() < 1e-7:
            break
    return at, size


def explained(residual: np.ndarray, patterns: np.ndarray) -> float:
    """Return the deviation (root mean square, m) that patterns (n, k) explain of residuals (n,), m, beyond chance.

    By chance, k patterns explain the share k / n of the variance on average; twice this share is subtracted.
    """
    count, k = patterns.shape
    size, direction = np.linalg.eigh(patterns.T @ patterns)
    share = (residual @ patterns) @ direction
    is_own = size > _LEAST_PRODUCT * size[-1]
    fitted = float((share[is_own] ** 2 / size[is_own]).sum())
    by_chance = k * float(residual @ residual) / count
    return float(np.sqrt(max(fitted - 2 * by_chance, 0.0) / count))


def bends(cylinder: Cylinder, xyz: np.ndarray) -> float:
    """Return the deviation (m) of points that a torus, a cone, a sphere or faces explain.

    The distances of the points of a cylinder from its axis depend on neither the position along it nor the angle
    around it. On a torus, a cone or a sphere they follow the position and its square, both also times the cosine and
    the sine of the angle. On faces they follow the angle.
    """
    along, distance, away = cylinder.local(xyz)
    u = (along - (along.max() + along.min()) / 2) / max(float(np.ptp(along)) / 2, 1e-9)
    first, second = axes_across(cylinder.axis)
    a, b = away @ first, away @ second
    square = u * u - 1 / 3
    # Faces that enclose the axis, from a flat bar to a hexagon.
    waves = [wave(k * np.arctan2(b, a)) for k in range(2, 7) for wave in (np.cos, np.sin)]
    patterns = np.column_stack([u, square, u * a, u * b, square * a, square * b, *waves])
    residual = distance - cylinder.radius
    return explained(residual - residual.mean(), patterns)
