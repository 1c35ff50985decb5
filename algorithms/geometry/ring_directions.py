"""Main directions of the walls of buildings, from rings along their outlines."""

from typing import Optional, Union

import numpy as np

from ..packages import ndimage

# Lengths (samples) of the pieces of a ring whose directions are taken: from a bay to a long front.
_LENGTHS = (4, 8, 16, 32, 64)

# Step of the directions (°).
_STEP = 0.5

# Steps of the directions from 0 to 90°.
N_STEPS = round(90.0 / _STEP)

# The directions (°) of these steps.
_TRIAL = _STEP * np.arange(N_STEPS)


class RingPieces:
    """The pieces of a ring, whose directions are counted: straight ones weigh more.

    Parameters
    ----------
    samples : ndarray of shape (n, 2)
        Positions at equal steps along a ring, the first not repeated.
    """

    def __init__(self, samples: np.ndarray) -> None:
        step = float(np.hypot(*(samples[1] - samples[0])))
        #: By the length of pieces: step of the directions (n,) below each one's, share (n,) of the one above, weight;
        #: only lengths (samples) that the ring is long enough for.
        self.of_length: dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        for length in _LENGTHS:
            if 2 * length <= len(samples):
                angle, across = _pieces(samples, length)
                position = (angle % 90.0) / _STEP
                low = np.floor(position).astype(np.int64)
                # Long walls count more than their length: by its power of 1.5. The weight falls where the standard
                # deviation across is more than a quarter of a sample, as such a piece is bent.
                weight = length**0.5 * np.exp(-((across / (0.25 * step)) ** 2) / 2)
                self.of_length[length] = low, position - low, weight

    def counted(self, length: int, counts: Optional[np.ndarray]) -> np.ndarray:
        """Return the sums (180,) of the weights of pieces by direction, each shared between the two steps around it.

        ``counts`` (n,) are factors of the weights of the pieces around each sample.
        """
        low, share, weight = self.of_length[length]
        if counts is not None:
            weight = weight * np.roll(counts, -(length // 2))
        numbers = np.concatenate([low % N_STEPS, (low + 1) % N_STEPS])
        return np.bincount(numbers, np.concatenate([weight * (1 - share), weight * share]), N_STEPS)


def direction_weights(samples: np.ndarray) -> np.ndarray:
    """Return the weights (180,) of directions from 0 to 90°, in steps of half a degree, along a ring.

    Parameters
    ----------
    samples : ndarray of shape (n, 2)
        Positions at equal steps along a ring, the first not repeated.

    Notes
    -----
    All pieces of a few lengths count, by how straight they are: no piece is chosen, so that the weights change by
    little with the samples.
    """
    return weights_of_pieces([RingPieces(samples)], [None])[0]


def weights_of_pieces(rings: list[RingPieces], counts: list[Optional[np.ndarray]]) -> np.ndarray:
    """Return weights as :func:`direction_weights` for some rings (r, 180), each with its ``counts``."""
    weights = np.zeros((len(rings), N_STEPS))
    for length in _LENGTHS:
        rows = [row for row, ring in enumerate(rings) if length in ring.of_length]
        if rows:
            counted = np.array([rings[row].counted(length, counts[row]) for row in rows])
            # Standard deviation (°) of the direction of a piece, half a sample across: 28.6° of one sample.
            width = np.hypot(1.0, 28.6 / length)
            weights[rows] += ndimage.gaussian_filter1d(counted, width / _STEP, mode="wrap")
    return weights


def main_directions(weights: np.ndarray, own: np.ndarray, n_samples: int) -> np.ndarray:
    """Return the main directions (k,), °, of a building: those from 0 to 90° with the greatest weights, at most two.

    Parameters
    ----------
    weights, own : ndarray of shape (180,)
        Weights of directions with its neighbors', and its own.
    n_samples : int
        Samples of its rings. A round building has no direction.
    """
    # No direction dominates where the lower quartile of the weights is more than 0.74 of their mean: 0.76 and more in
    # simulated towers, 0.72 and less in 30 real buildings, all of which have at least 50 samples.
    if n_samples >= 50 and np.percentile(own, 25) > 0.74 * own.mean():
        return np.zeros(0)
    angles = [_peak(weights, int(np.argmax(weights)))]
    is_top = (weights >= np.roll(weights, 1)) & (weights > np.roll(weights, -1))
    # A second direction is at least 12° off, with at least a quarter of the weight.
    other = np.where(is_top & (_off(_TRIAL, angles[0]) >= 12.0), weights, 0.0)
    if other.max() >= 0.25 * weights.max() > 0:
        angles.append(_peak(weights, int(np.argmax(other))))
    return np.array(angles)


def deviations(samples: np.ndarray, length: int) -> np.ndarray:
    """Return the standard deviation (n,), m, across the piece of ``length`` samples from each (n, 2) of a ring on."""
    return _pieces(samples, length)[1]


def _pieces(samples: np.ndarray, length: int) -> tuple[np.ndarray, np.ndarray]:
    """Return direction (°) and standard deviation across (m) of the pieces of ``length`` samples from each on."""
    ring = np.concatenate([samples, samples[:length]]) - samples.mean(axis=0)
    products = np.column_stack([ring, ring**2, ring[:, 0] * ring[:, 1]])
    total = np.concatenate([np.zeros((1, 5)), np.cumsum(products, axis=0)])
    mean = (total[length:] - total[:-length])[: len(samples)] / length
    x, y, xx, yy, xy = mean.T
    xx, yy, xy = xx - x * x, yy - y * y, xy - x * y
    angle = np.degrees(np.arctan2(2 * xy, xx - yy)) / 2
    across = (xx + yy) / 2 - np.hypot((xx - yy) / 2, xy)
    return angle, np.sqrt(np.maximum(across, 0.0))


def _peak(weights: np.ndarray, at: int) -> float:
    """Return the angle (°) of the top of a parabola through the weight of a step and those next to it."""
    before, top, after = weights[[at - 1, at, (at + 1) % len(weights)]]
    bend = before - 2 * top + after
    shift = 0.5 * (before - after) / bend if bend < 0 else 0.0
    return float((at + shift) * _STEP % 90.0)


def _off(angle: np.ndarray, other: Union[float, np.ndarray]) -> np.ndarray:
    """Return the differences (°), 0 to 45, between directions modulo 90°."""
    return np.abs((angle - other + 45.0) % 90.0 - 45.0)


def along_two_directions(length: np.ndarray, angle: np.ndarray) -> float:
    """Return the greatest length (m) of edges along two directions that are square to each other.

    Parameters
    ----------
    length : ndarray of shape (n,)
        Lengths of the edges, m.
    angle : ndarray of shape (n,)
        Their directions, °.
    """
    # Within 3°: the deviation of an edge of 6 m whose ends lie 0.3 m apart across.
    return float(((_off(angle, _TRIAL[:, None]) <= 3.0) * length).sum(axis=1).max())
