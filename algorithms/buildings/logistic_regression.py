"""Logistic regression on piecewise linear features, in numpy alone: the same result on every machine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..rules import rule, rules


@rules
class _RULES:
    """How the regression is fitted."""

    steps: int = rule(20, "steps", "numerics: Newton's method converges in 6 to 9")
    digits: int = rule(
        6, "decimals", "numerics: of the weights, so that rounding changes none; smaller steps end the fit"
    )
    block: int = rule(64, "rows", "numerics: products this small are computed by one thread, in one order")


@dataclass(frozen=True)
class LogisticRegression:
    """A fitted regression: mean and standard deviation (f,) of the features, weights (2 f + 1,), the constant first."""

    mean: np.ndarray
    scale: np.ndarray
    weights: np.ndarray

    @classmethod
    def fit(cls, features: np.ndarray, labels: np.ndarray) -> LogisticRegression:
        """Return the regression of ``labels`` (k,), 0 to 1, on ``features`` (k, f), k >= 1."""
        mean, scale = features.mean(axis=0), features.std(axis=0)
        scale = np.where(scale > 0, scale, 1.0)
        terms = _terms(features, mean, scale)
        # A standard normal prior of the weights: correlated features do not get large weights of opposite sign.
        penalty = np.ones(terms.shape[1])
        # The constant is nearly free: this small penalty keeps it finite where all labels are equal.
        penalty[0] = 10.0**-_RULES.digits
        weights = np.zeros(terms.shape[1])
        for _ in range(_RULES.steps):
            likely = _probability(terms, weights)
            gradient = np.einsum("ij,i->j", terms, labels - likely) - penalty * weights
            step = np.linalg.solve(_curvature(terms, likely * (1 - likely)) + np.diag(penalty), gradient)
            weights = weights + step
            if np.abs(step).max() <= 10.0**-_RULES.digits:
                break
        return cls(mean, scale, np.round(weights, _RULES.digits))

    def predict(self, features: np.ndarray) -> np.ndarray:
        """Return the probability (k,) of features (k, f)."""
        return _probability(_terms(features, self.mean, self.scale), self.weights)


def _terms(features: np.ndarray, mean: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Return 1, the standardized features and their positive parts (k, 2 f + 1): lines that bend at the mean."""
    standard = (features - mean) / scale
    return np.concatenate([np.ones((len(features), 1)), standard, np.maximum(standard, 0)], axis=1)


def _probability(terms: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the probabilities (k,) of terms (k, t)."""
    # Sum in a fixed order, which a threaded matrix product would not keep. Beyond 30, probabilities are 0 or 1 within
    # 1e-13.
    return 1 / (1 + np.exp(-np.clip(np.einsum("ij,j->i", terms, weights), -30, 30)))


def _curvature(terms: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Return the weighted products (t, t) of the columns of terms (k, t)."""
    missing = -len(terms) % _RULES.block
    padded = np.concatenate([terms, np.zeros((missing, terms.shape[1]))])
    weighted = padded * np.append(weight, np.zeros(missing))[:, None]
    left, right = (values.reshape(-1, _RULES.block, terms.shape[1]) for values in (weighted, padded))
    return np.matmul(left.transpose(0, 2, 1), right).sum(axis=0)
