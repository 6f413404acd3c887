# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a picture is from its reference. Pictures are (H, W, 3), scene-linear Rec.709."""

import numpy as np

EPSILON = 0.01
LEFT_OUT = 0.001
"""The share of the pixels, the worst ones, that relative_mse leaves out: a firefly is not to outweigh a picture."""


def relative_mse(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean of (picture - reference)^2 / (reference^2 + EPSILON) over the channels and all but the worst pixels.

    picture, reference: (..., 3). What is not finite counts as black.
    """
    picture, reference = np.nan_to_num(picture, posinf=0.0, neginf=0.0).astype(np.float64), reference.astype(np.float64)
    errors = ((picture - reference) ** 2 / (reference**2 + EPSILON)).mean(axis=-1).ravel()
    kept = errors.size - round(LEFT_OUT * errors.size)
    return float(np.partition(errors, kept - 1)[:kept].mean())


def mean_ratio(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean radiance over the reference's."""
    return float(np.nanmean(picture, dtype=np.float64) / np.mean(reference, dtype=np.float64))


def caustic_mask(reference: np.ndarray, without: np.ndarray) -> np.ndarray:
    """(H, W) bool: where caustics add more than a twentieth of what they add at their brightest (99th percentile).

    without: the picture without light that reaches diffuse surfaces by glass or mirrors.
    """
    added = (reference - without).mean(axis=-1)
    return added > 0.05 * np.percentile(added, 99.0)


def caustic_ratio(picture: np.ndarray, reference: np.ndarray, without: np.ndarray) -> float:
    """Return what caustics add within their mask, over what they add in the reference: 0 where there are none."""
    mask = caustic_mask(reference, without)
    base = without[mask].mean(dtype=np.float64)
    return float((np.nanmean(picture[mask], dtype=np.float64) - base) / (reference[mask].mean(dtype=np.float64) - base))


def gradients_kept(picture: np.ndarray, reference: np.ndarray, mask: np.ndarray) -> tuple[float, float]:
    """How sharp a picture is within a mask, by the gradients of luminance: the part of the reference's that it has,
    which blur makes less than 1 and noise does not change, and its energy over the reference's, to which noise adds.
    """
    weights = np.array([0.2126, 0.7152, 0.0722])
    found, wanted = (
        np.stack(np.gradient(pixels.astype(np.float64) @ weights))[:, mask] for pixels in (picture, reference)
    )
    energy = (wanted**2).sum()
    return float((found * wanted).sum() / energy), float((found**2).sum() / energy)


def exposure_of(reference: np.ndarray) -> float:
    """A factor that brings the median of what is lit to 0.25, the same for all pictures of a scene."""
    luminance = reference @ np.array([0.2126, 0.7152, 0.0722])
    lit = luminance[luminance > 1e-4]
    return 0.25 / float(np.median(lit)) if lit.size else 1.0


def displayed(picture: np.ndarray, exposure: float) -> np.ndarray:
    """(H, W, 3) float32 in [0, 1] as an sRGB display shows it."""
    linear = np.clip(np.nan_to_num(picture) * exposure, 0.0, 1.0)
    curved = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return curved.astype(np.float32)


def flip(picture: np.ndarray, reference: np.ndarray, exposure: float, counted: np.ndarray | None = None) -> float:
    """Mean LDR-FLIP (Andersson et al. 2020) of the two as displayed, at the default 67 pixels per degree.

    counted: (H, W) bool, the pixels of which the mean is taken; all without it.
    """
    import flip_evaluator  # late: the bench extra

    errors, mean, _ = flip_evaluator.evaluate(
        displayed(reference, exposure), displayed(picture, exposure), "LDR", applyMagma=False
    )
    return float(mean) if counted is None else float(errors[counted].mean())


def convergence_rate(counts: list[float], errors: list[float]) -> float:
    """The power p of error = c count^-p that fits best in logarithms; NaN for less than two points."""
    if len(counts) < 2:
        return float("nan")
    return float(-np.polyfit(np.log(counts), np.log(errors), 1)[0])
