# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that give a colour or a number: their constant value, or the value that comes closest."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .links import Path, Source, find_source, named_input

if TYPE_CHECKING:
    from .values import Evaluator, Value

Reader = Callable[["Evaluator", bpy.types.Node, bpy.types.NodeSocket, Path], "Value | None"]
_READERS: dict[str, Reader] = {}


def evaluate(evaluator: "Evaluator", source: Source) -> "Value | None":
    """The value of an output; None when nothing better than the reader's own value is known."""
    reader = _READERS.get(source.node.type)
    if reader is None:
        evaluator.warn(source.node, "is not rendered yet; the value of the socket it feeds is used")
        return None
    return reader(evaluator, source.node, source.output, source.path)


def _reads(*types: str) -> Callable[[Reader], Reader]:
    def keep(reader: Reader) -> Reader:
        _READERS.update(dict.fromkeys(types, reader))
        return reader

    return keep


def _constant(color: object) -> "Value":
    from .values import Value

    return Value(np.broadcast_to(np.asarray(color, np.float64), 3).copy())


@_reads("RGB")
def _rgb(evaluator, node, output, path):
    return _constant(node.outputs[0].default_value[:3])


@_reads("VALUE")
def _value(evaluator, node, output, path):
    return _constant(node.outputs[0].default_value)


@_reads("BLACKBODY")
def _blackbody(evaluator, node, output, path):
    return _constant(blackbody(evaluator.scalar(node.inputs[0], path)))


@_reads("TEX_IMAGE")
def _image_texture(evaluator, node, output, path):
    from .values import Value

    if node.image is None:
        evaluator.warn(node, "has no image and counts as magenta; choose one")
        return _constant((1.0, 0.0, 1.0))
    _check_coordinates(evaluator, node, path)
    if output.name == "Alpha":
        return _constant(evaluator.images.mean_alpha(node.image, node, evaluator))
    index = evaluator.images.index(node.image, node, evaluator)
    if index is None:
        return _constant((1.0, 0.0, 1.0))
    return Value(np.ones(3), index)


def _check_coordinates(evaluator: "Evaluator", node: bpy.types.Node, path: Path) -> None:
    if node.projection != "FLAT":
        evaluator.warn(node, f"is projected as {node.projection}; the UV map is used")
    source = find_source(node.inputs["Vector"], path)
    if not isinstance(source, Source):
        return
    plain = (source.node.type == "TEX_COORD" and source.output.name == "UV") or (
        source.node.type == "UVMAP" and not source.node.uv_map
    )
    if not plain:
        evaluator.warn(
            node, f'is placed by node "{source.node.name}" ({source.node.type}); the render UV map is used as it is'
        )


@_reads("TEX_ENVIRONMENT")
def _environment_texture(evaluator, node, output, path):
    if node.image is None:
        evaluator.warn(node, "has no image and counts as magenta; choose one")
        return _constant((1.0, 0.0, 1.0))
    index = evaluator.images.index(node.image, node, evaluator)
    if index is None:
        return _constant((1.0, 0.0, 1.0))
    evaluator.warn(node, "is changed on its way to the output, which is not rendered yet; its mean colour is used")
    return _constant(evaluator.images.mean(index))


@_reads("MATH")
def _math(evaluator, node, output, path):
    numbers = [evaluator.scalar(socket, path) for socket in node.inputs if socket.enabled]
    operation = _MATH.get(node.operation)
    if operation is None:
        evaluator.warn(node, f"has the operation {node.operation}, which is not rendered yet; its first input is used")
        result = numbers[0]
    else:
        try:
            result = float(operation(*numbers))
        except (ArithmeticError, ValueError):
            result = 0.0
    return _constant(min(max(result, 0.0), 1.0) if node.use_clamp else result)


_MATH = {
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "DIVIDE": lambda a, b: a / b,
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b: math.pow(a, b),
    "SQRT": math.sqrt,
    "ABSOLUTE": abs,
    "MINIMUM": min,
    "MAXIMUM": max,
    "LESS_THAN": lambda a, b: a < b,
    "GREATER_THAN": lambda a, b: a > b,
    "ROUND": lambda a: math.floor(a + 0.5),
    "FLOOR": math.floor,
    "CEIL": math.ceil,
}


@_reads("MIX", "MIX_RGB")
def _mix(evaluator, node, output, path):
    """A colour or number mixed by a constant factor; one image among them survives where it can."""
    from .values import Value

    if node.type == "MIX" and node.data_type not in {"RGBA", "FLOAT", "VECTOR"}:
        evaluator.warn(node, f"mixes {node.data_type}, which is not rendered yet")
        return None
    blend = node.blend_type if node.type == "MIX_RGB" or node.data_type == "RGBA" else "MIX"
    factor = evaluator.scalar(named_input(node, "Factor", "Fac"), path)
    if getattr(node, "clamp_factor", True):
        factor = min(max(factor, 0.0), 1.0)
    first = evaluator.value(named_input(node, "A", "Color1"), path)
    second = evaluator.value(named_input(node, "B", "Color2"), path)
    if factor == 0.0:
        return first
    if blend == "MIX" and factor == 1.0:
        return second
    # Multiplying keeps an image exact, whatever the factor, when the other side is one constant.
    if blend == "MULTIPLY":
        if second.image < 0:
            return Value(first.color * (1.0 - factor + factor * second.color), first.image)
        if first.image < 0 and factor == 1.0:
            return Value(first.color * second.color, second.image)
    if first.image >= 0 or second.image >= 0:
        evaluator.warn(node, "mixes images in a way that is not rendered yet; their mean colour is used")
    a, b = evaluator.mean(first), evaluator.mean(second)
    blended = _BLENDS.get(blend)
    if blended is None:
        evaluator.warn(node, f"blends by {blend}, which is not rendered yet; it mixes plainly")
        blended = _BLENDS["MIX"]
    result = a * (1.0 - factor) + blended(a, b) * factor
    clamped = getattr(node, "clamp_result", False) or getattr(node, "use_clamp", False)
    return _constant(np.clip(result, 0.0, 1.0) if clamped else result)


_BLENDS = {
    "MIX": lambda a, b: b,
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "SCREEN": lambda a, b: 1.0 - (1.0 - a) * (1.0 - b),
    "DIFFERENCE": lambda a, b: np.abs(a - b),
    "DARKEN": np.minimum,
    "LIGHTEN": np.maximum,
}


def _changed(evaluator: "Evaluator", node: bpy.types.Node, value: "Value", change: Callable) -> "Value":
    """A colour changed by a node; an image can only be changed as a whole, by its mean."""
    if value.image >= 0:
        evaluator.warn(node, "changes an image in a way that is not rendered yet; the image passes through unchanged")
        return value
    return _constant(change(value.color))


@_reads("GAMMA")
def _gamma(evaluator, node, output, path):
    gamma = evaluator.scalar(node.inputs["Gamma"], path)
    value = evaluator.value(node.inputs["Color"], path)
    if gamma == 1.0:
        return value

    def change(color: np.ndarray) -> np.ndarray:
        return np.where(color > 0.0, np.maximum(color, 0.0) ** gamma, color)

    return _changed(evaluator, node, value, change)


@_reads("INVERT")
def _invert(evaluator, node, output, path):
    factor = evaluator.scalar(named_input(node, "Factor", "Fac"), path)
    value = evaluator.value(node.inputs["Color"], path)
    if factor == 0.0:
        return value
    return _changed(evaluator, node, value, lambda color: color * (1.0 - factor) + (1.0 - color) * factor)


@_reads("BRIGHTCONTRAST")
def _bright_contrast(evaluator, node, output, path):
    bright = evaluator.scalar(node.inputs["Bright"], path)
    contrast = evaluator.scalar(node.inputs["Contrast"], path)
    value = evaluator.value(node.inputs["Color"], path)
    if bright == 0.0 and contrast == 0.0:
        return value
    return _changed(
        evaluator,
        node,
        value,
        lambda color: np.maximum((1.0 + contrast) * color + bright - 0.5 * contrast, 0.0),
    )


@_reads("VALTORGB")
def _color_ramp(evaluator, node, output, path):
    position = evaluator.scalar(named_input(node, "Factor", "Fac"), path)
    color = node.color_ramp.evaluate(min(max(position, 0.0), 1.0))
    return _constant(color[3] if output.name == "Alpha" else color[:3])


@_reads("COMBINE_COLOR", "COMBRGB", "COMBXYZ")
def _combine(evaluator, node, output, path):
    if getattr(node, "mode", "RGB") != "RGB":
        evaluator.warn(node, f"combines {node.mode}, which is not rendered yet")
        return None
    return _constant([evaluator.scalar(socket, path) for socket in node.inputs])


@_reads("SEPARATE_COLOR", "SEPRGB", "SEPXYZ")
def _separate(evaluator, node, output, path):
    if getattr(node, "mode", "RGB") != "RGB":
        evaluator.warn(node, f"separates {node.mode}, which is not rendered yet")
        return None
    value = evaluator.value(node.inputs[0], path)
    if value.image >= 0:
        evaluator.warn(node, "separates an image, which is not rendered yet; its mean is used")
    channel = [socket.identifier for socket in node.outputs].index(output.identifier)
    return _constant(evaluator.mean(value)[channel])


@_reads("RGBTOBW")
def _to_grey(evaluator, node, output, path):
    return _constant(evaluator.scalar(node.inputs[0], path))


@_reads("TEX_CHECKER")
def _checker(evaluator, node, output, path):
    evaluator.warn(node, "is not rendered yet; the mean of its two colours is used")
    if output.name != "Color":
        return _constant(0.5)
    return _constant(
        0.5 * (evaluator.mean_color(node.inputs["Color1"], path) + evaluator.mean_color(node.inputs["Color2"], path))
    )


@_reads("TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_MAGIC", "TEX_GRADIENT", "TEX_WHITE_NOISE", "TEX_MUSGRAVE")
def _noise(evaluator, node, output, path):
    evaluator.warn(node, "is not rendered yet; grey 0.5 is used")
    return _constant(0.5)


@_reads("TEX_BRICK")
def _brick(evaluator, node, output, path):
    evaluator.warn(node, "is not rendered yet; the mean of its bricks is used")
    if output.name != "Color":
        return _constant(0.0)
    return _constant(
        0.5 * (evaluator.mean_color(node.inputs["Color1"], path) + evaluator.mean_color(node.inputs["Color2"], path))
    )


@_reads("HUE_SAT", "CURVE_RGB")
def _pass_on(evaluator, node, output, path):
    evaluator.warn(node, "is not rendered yet; its colour passes through unchanged")
    return evaluator.value(node.inputs["Color"], path)


@_reads("CLAMP", "MAP_RANGE", "CURVE_FLOAT")
def _pass_number(evaluator, node, output, path):
    evaluator.warn(node, "is not rendered yet; its value passes through unchanged")
    return evaluator.value(named_input(node, "Value"), path)


@_reads("FRESNEL")
def _fresnel(evaluator, node, output, path):
    evaluator.warn(node, "varies with the view; its mean is used")
    return _constant(mean_fresnel(evaluator.scalar(node.inputs["IOR"], path)))


@_reads("LAYER_WEIGHT")
def _layer_weight(evaluator, node, output, path):
    evaluator.warn(node, "varies with the view; its mean is used")
    blend = min(max(evaluator.scalar(node.inputs["Blend"], path), 0.0), 0.99999)
    if output.name == "Fresnel":
        return _constant(mean_fresnel(1.0 / max(1.0 - blend, 1e-5)))
    exponent = 2.0 * blend if blend < 0.5 else 0.5 / (1.0 - blend)
    # Mean of 1 - cos^exponent over a surface seen from everywhere (weighted by the cosine).
    return _constant(1.0 - 2.0 / (exponent + 2.0))


@_reads("LIGHT_PATH")
def _light_path(evaluator, node, output, path):
    evaluator.warn(node, "varies with the path; what the camera sees is used everywhere")
    return _constant(1.0 if output.name == "Is Camera Ray" else 0.0)


@_reads("NEW_GEOMETRY")
def _geometry(evaluator, node, output, path):
    if output.name != "Backfacing":
        evaluator.warn(node, "is not rendered yet; the value of the socket it feeds is used")
        return None
    evaluator.warn(node, "varies with the side; the front is used")
    return _constant(0.0)


def mean_fresnel(ior: float) -> float:
    """Reflectance of a dielectric, averaged over the hemisphere by the cosine."""
    ior = max(ior, 1e-5)
    cosine = np.sqrt((np.arange(256) + 0.5) / 256.0)  # cosine-weighted directions
    squared = 1.0 - (1.0 - cosine**2) / ior**2
    inside = np.sqrt(np.maximum(squared, 0.0))
    perpendicular = ((cosine - ior * inside) / (cosine + ior * inside)) ** 2
    parallel = ((ior * cosine - inside) / (ior * cosine + inside)) ** 2
    return float(np.where(squared < 0.0, 1.0, 0.5 * (perpendicular + parallel)).mean())


def blackbody(kelvin: float) -> np.ndarray:
    """Colour of a black body in linear Rec.709 with luminance 1, (3,) float64.

    Planck's law seen through the CIE 1931 observer (the multi-lobe fit of Wyman, Sloan and
    Shirley, 2013), over the temperatures that Blender's Blackbody node takes, 800 to 12000 K.
    """
    kelvin = min(max(kelvin, 800.0), 12000.0)
    wavelength = np.arange(380.0, 781.0, 5.0)  # nm
    spectrum = 1.0 / (wavelength**5 * np.expm1(1.4387769e7 / (wavelength * kelvin)))

    def lobe(height: float, centre: float, below: float, above: float) -> np.ndarray:
        distance = (wavelength - centre) * np.where(wavelength < centre, below, above)
        return height * np.exp(-0.5 * distance**2)

    x = lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382)
    y = lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322)
    z = lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)
    xyz = np.array([(curve * spectrum).sum() for curve in (x, y, z)])
    to_rec709 = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])
    return np.maximum(to_rec709 @ (xyz / xyz[1]), 0.0)
