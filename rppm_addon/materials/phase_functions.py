# SPDX-License-Identifier: GPL-3.0-or-later
"""Phase functions of volume nodes: their parameters, by the inputs of the nodes."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from .nodes.volumes import MIE_LOBES
from .records import PhaseFunctionKind

Parameters = tuple[float, float, float, float]
"""Parameters of a PHASE_FUNCTION record (PhaseFunctionKind)."""

_MOST_ANISOTROPY = 1.0 - 1e-3
"""Magnitude to which Cycles clamps the anisotropy, beyond which light would not be scattered."""
_IOR_RANGE = (1.01, 3.0)
_BACKSCATTER_RANGE = (1e-4, 0.5 - 1e-4)
"""Fraction of the light that is scattered backward, for which the function is one."""


@dataclass(frozen=True)
class PhaseModel:
    """A phase function by the inputs of a volume node."""

    kind: PhaseFunctionKind
    inputs: tuple[str, ...]
    """Names of the node's inputs that it depends on, at most three."""
    parameters: Callable[..., Parameters]
    """Gives the parameters by the values of the inputs, floats."""
    mie_lobe: str = MIE_LOBES[0]
    """Lobe of the mixture that stands for Mie's phase function."""


def _clamped(anisotropy: float) -> float:
    return min(max(anisotropy, -_MOST_ANISOTROPY), _MOST_ANISOTROPY)


def henyey_greenstein(anisotropy: float) -> Parameters:
    """Return the parameters of the function of Henyey and Greenstein."""
    return _clamped(anisotropy), 0.0, 0.0, 0.0


def draine(anisotropy: float, alpha: float) -> Parameters:
    """Return the parameters of Draine's function."""
    return _clamped(anisotropy), max(alpha, 0.0), 0.0, 0.0


def rayleigh() -> Parameters:
    """Return the parameters of Rayleigh's function, which has none."""
    return 0.0, 0.0, 0.0, 0.0


def fournier_forand(ior: float, backscatter: float) -> Parameters:
    """Return the parameters of the function of Fournier and Forand, of the index of particles relative to the medium
    and of the fraction of the light that they scatter backward."""
    n = min(max(ior, _IOR_RANGE[0]), _IOR_RANGE[1])
    b = min(max(backscatter, _BACKSCATTER_RANGE[0]), _BACKSCATTER_RANGE[1])
    delta_180 = 4.0 / (3.0 * (n - 1.0) ** 2)
    delta_90 = 0.5 * delta_180
    nu = -math.log1p(2.0 * b * (delta_90 - 1.0)) / math.log(delta_90) if abs(delta_90 - 1.0) > 1e-6 else -2.0 * b
    factor = math.expm1(-nu * math.log(delta_180)) / (delta_180 - 1.0) if abs(delta_180 - 1.0) > 1e-6 else -nu
    return n, nu, factor, 0.0


def mie_henyey_greenstein(diameter: float) -> Parameters:
    """Return the parameters of one of the lobes that stand for Mie's function, by the diameter of droplets,
    micrometers (Jendersie and d'Eon 2023)."""
    d = max(diameter, 1e-6)
    log_d = math.log(d)
    if d <= 0.1:
        g = 13.8 * d * d
    elif d < 1.5:
        g = 0.862 - 0.143 * log_d**2
    elif d < 5.0:
        g = 0.0604931 * math.log(log_d) + 0.940256
    else:
        g = math.exp(-0.0990567 / (d - 1.67154))
    return henyey_greenstein(g)


def mie_draine(diameter: float) -> Parameters:
    """Return the parameters of the other lobe."""
    d = max(diameter, 1e-6)
    log_d = math.log(d)
    alpha = 250.0
    if d <= 0.1:
        g = 1.1456 * d * math.sin(9.29044 * d)
    elif d < 1.5:
        ratio = (log_d - 0.238604) * (log_d + 1.00667) / (0.507522 - 0.15677 * log_d)
        g = 0.379685 * math.cos(1.19692 * math.cos(ratio) + 1.37932 * log_d + 0.0625835) + 0.344213
    elif d < 5.0:
        g = 0.500411 - 0.081287 / (-2.0 * log_d + math.tan(log_d) + 1.27551)
        alpha = 7.30354 * log_d + 6.31675
    else:
        g = math.exp(-2.20679 / (d + 3.91029) - 0.428934)
        alpha = math.exp(3.62489 - 8.29288 / (d + 5.52825))
    return draine(g, alpha)


HENYEY_GREENSTEIN = PhaseModel(PhaseFunctionKind.HENYEY_GREENSTEIN, ("anisotropy",), henyey_greenstein)
MODELS: dict[str, tuple[PhaseModel, ...]] = {
    "HENYEY_GREENSTEIN": (HENYEY_GREENSTEIN,),
    "FOURNIER_FORAND": (PhaseModel(PhaseFunctionKind.FOURNIER_FORAND, ("ior", "backscatter"), fournier_forand),),
    "DRAINE": (PhaseModel(PhaseFunctionKind.DRAINE, ("anisotropy", "alpha"), draine),),
    "RAYLEIGH": (PhaseModel(PhaseFunctionKind.RAYLEIGH, (), rayleigh),),
    "MIE": (
        PhaseModel(PhaseFunctionKind.HENYEY_GREENSTEIN, ("diameter",), mie_henyey_greenstein, MIE_LOBES[0]),
        PhaseModel(PhaseFunctionKind.DRAINE, ("diameter",), mie_draine, MIE_LOBES[1]),
    ),
}
"""Phase functions that a volume node scatters by, by its option "phase"."""
