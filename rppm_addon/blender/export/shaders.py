# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes to lobes."""

from collections.abc import Callable

import bpy
import numpy as np

from ...scene import Lobe, LobeKind
from .links import Path, named_input
from .values import Evaluator, Shader, Value

Maker = Callable[[list[Lobe], Evaluator, float, bpy.types.Node, Path], None]


def add_lobes(lobes: list[Lobe], evaluator: Evaluator, shader: Shader) -> None:
    """Append the lobes of one shader node; one that is not known becomes the nearest that is."""
    weight, node, path = shader.weight, shader.node, shader.path
    if shader.type == "COLOR":
        lobes.append(_colored(LobeKind.EMISSION, weight, shader.color))
        return
    maker = _MAKERS.get(shader.type)
    if maker is not None:
        maker(lobes, evaluator, weight, node, path)
        return
    color = named_input(node, "Color", "Base Color")
    value = evaluator.value(color, path) if color is not None else Value(np.full(3, 0.8))
    evaluator.warn(node, "is not rendered yet; a diffuse surface of its colour stands in")
    lobes.append(_colored(LobeKind.DIFFUSE, weight, value))


def _colored(kind: LobeKind, weight: float, value: Value, **parameters: object) -> Lobe:
    color = tuple(np.maximum(value.color, 0.0).tolist())
    return Lobe(kind, weight=weight, color=color, color_image=value.image, **parameters)


def _unit(number: float) -> float:
    return min(max(number, 0.0), 1.0)


def _diffuse(lobes, evaluator, weight, node, path):
    evaluator.ignore(node, path, "Roughness", "Normal")
    lobes.append(_colored(LobeKind.DIFFUSE, weight, evaluator.value(node.inputs["Color"], path)))


def _glossy(lobes, evaluator, weight, node, path):
    evaluator.ignore(node, path, "Anisotropy", "Normal")
    lobes.append(
        _colored(
            LobeKind.GLOSSY,
            weight,
            evaluator.value(node.inputs["Color"], path),
            roughness=_roughness(evaluator, node, path),
            multiscatter=node.distribution == "MULTI_GGX",
        )
    )


def _glass(lobes, evaluator, weight, node, path):
    evaluator.ignore(node, path, "Thin Film Thickness", "Normal")
    lobes.append(
        _colored(
            LobeKind.GLASS,
            weight,
            evaluator.value(node.inputs["Color"], path),
            roughness=_roughness(evaluator, node, path),
            ior=_ior(evaluator, node, path),
            multiscatter=node.distribution == "MULTI_GGX",
        )
    )


def _refraction(lobes, evaluator, weight, node, path):
    evaluator.ignore(node, path, "Normal")
    lobes.append(
        _colored(
            LobeKind.REFRACTION,
            weight,
            evaluator.value(node.inputs["Color"], path),
            roughness=_roughness(evaluator, node, path),
            ior=_ior(evaluator, node, path),
        )
    )


def _transparent(lobes, evaluator, weight, node, path):
    lobes.append(_colored(LobeKind.TRANSPARENT, weight, evaluator.value(node.inputs["Color"], path)))


def _emission(lobes, evaluator, weight, node, path):
    value = evaluator.value(node.inputs["Color"], path)
    strength = max(evaluator.scalar(node.inputs["Strength"], path), 0.0)
    if strength > 0.0 and value.color.any():
        lobes.append(_colored(LobeKind.EMISSION, weight, Value(value.color * strength, value.image)))


def _principled(lobes, evaluator, weight, node, path):
    evaluator.ignore(
        node, path,
        "Diffuse Roughness", "Subsurface Weight", "Anisotropic", "Coat Weight", "Sheen Weight",
        "Thin Film Thickness", "Thin Wall", "Normal",
    )  # fmt: skip
    base = evaluator.value(node.inputs["Base Color"], path)
    alpha = _unit(evaluator.scalar(node.inputs["Alpha"], path))
    glow = evaluator.value(named_input(node, "Emission Color", "Emission"), path)
    strength = max(evaluator.scalar(named_input(node, "Emission Strength"), path), 0.0)
    lobe = _colored(
        LobeKind.PRINCIPLED,
        weight,
        base,
        roughness=_roughness(evaluator, node, path),
        ior=_ior(evaluator, node, path),
        multiscatter=node.distribution == "MULTI_GGX",
        metallic=_unit(evaluator.scalar(node.inputs["Metallic"], path)),
        specular_level=max(evaluator.scalar(named_input(node, "Specular IOR Level"), path, 0.5), 0.0),
        specular_tint=tuple(np.maximum(evaluator.mean_color(node.inputs["Specular Tint"], path), 0.0).tolist()),
        transmission=_unit(evaluator.scalar(named_input(node, "Transmission Weight"), path)),
        alpha=alpha,
    )
    lobes.append(lobe)
    if strength > 0.0 and glow.image < 0:
        lobe.emission = tuple((np.maximum(glow.color, 0.0) * strength).tolist())
    elif strength > 0.0 and alpha > 0.0:
        # An image cannot be a parameter of the Principled lobe: it glows beside it.
        lobes.append(_colored(LobeKind.EMISSION, weight * alpha, Value(glow.color * strength, glow.image)))


def _metallic(lobes, evaluator, weight, node, path):
    evaluator.ignore(node, path, "Anisotropy", "Thin Film Thickness", "Normal")
    if node.fresnel_type == "F82":
        value = evaluator.value(node.inputs["Base Color"], path)
        evaluator.warn(node, "is rendered without its edge tint")
    else:
        ior, extinction = (np.array(node.inputs[name].default_value[:3]) for name in ("IOR", "Extinction"))
        value = Value(((ior - 1.0) ** 2 + extinction**2) / ((ior + 1.0) ** 2 + extinction**2))
        evaluator.warn(node, "is rendered with the colour it has seen straight on")
    lobes.append(
        _colored(
            LobeKind.PRINCIPLED,
            weight,
            value,
            metallic=1.0,
            roughness=_roughness(evaluator, node, path),
            multiscatter=node.distribution == "MULTI_GGX",
        )
    )


def _specular(lobes, evaluator, weight, node, path):
    evaluator.ignore(node, path, "Clear Coat", "Normal", "Ambient Occlusion")
    evaluator.warn(node, "is rendered as a Principled surface")
    specular = float(evaluator.mean_color(node.inputs["Specular"], path).mean())
    lobes.append(
        _colored(
            LobeKind.PRINCIPLED,
            weight,
            evaluator.value(node.inputs["Base Color"], path),
            specular_level=specular / 0.08,
            roughness=_roughness(evaluator, node, path),
        )
    )


def _background(lobes, evaluator, weight, node, path):
    evaluator.warn(node, "belongs to a world and is rendered as emission")
    _emission(lobes, evaluator, weight, node, path)


def _holdout(lobes, evaluator, weight, node, path):
    evaluator.warn(node, "is not rendered yet; the surface is black")


def _ray_portal(lobes, evaluator, weight, node, path):
    evaluator.warn(node, "is not rendered yet; the surface lets light pass straight through")
    _transparent(lobes, evaluator, weight, node, path)


def _roughness(evaluator: Evaluator, node: bpy.types.Node, path: Path) -> float:
    if getattr(node, "distribution", "GGX") == "SHARP":
        return 0.0
    return _unit(evaluator.scalar(node.inputs["Roughness"], path))


def _ior(evaluator: Evaluator, node: bpy.types.Node, path: Path) -> float:
    return max(evaluator.scalar(node.inputs["IOR"], path), 1e-5)


_MAKERS: dict[str, Maker] = {
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLOSSY": _glossy,
    "BSDF_ANISOTROPIC": _glossy,
    "BSDF_GLASS": _glass,
    "BSDF_REFRACTION": _refraction,
    "BSDF_TRANSPARENT": _transparent,
    "EMISSION": _emission,
    "BSDF_PRINCIPLED": _principled,
    "BSDF_METALLIC": _metallic,
    "EEVEE_SPECULAR": _specular,
    "BACKGROUND": _background,
    "HOLDOUT": _holdout,
    "BSDF_RAY_PORTAL": _ray_portal,
}
