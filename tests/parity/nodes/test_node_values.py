# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of the nodes that compute numbers, vectors and colors, against Cycles'."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from rppm_addon.materials.nodes import color, curves, math, spectrum, view
from rppm_addon.materials.nodes.node_kinds import BOOLEAN

from .names import blender_node
from .value_grids import (
    CAMERA_MATRIX,
    OBJECT_MATRIX,
    RAY_LENGTH,
    Case,
    assert_exported,
    assert_values_agree,
    cycles_values,
    grid,
    our_values,
)

NUMBERS = (-12.3, -2.0, -1.5, -1.0, -0.3, 0.0, 0.25, 0.5, 1.0, 1.7, 3.0, 20.0)
FEW = (-2.0, 0.0, 0.3, 1.0, 4.5)


KINDS = math.KINDS | color.KINDS | curves.KINDS | view.KINDS | spectrum.KINDS


def case(name: str, inputs: dict[str, np.ndarray], options: dict | None = None, **members: object) -> Case:
    return Case(name, KINDS[name], blender_node(name), inputs, options or {}, **members)


def math_cases() -> list[Case]:
    a, b, c = grid(NUMBERS, NUMBERS, FEW)
    inputs = {"value": a, "value_001": b, "value_002": c}
    return [
        case("math", inputs, {"operation": operation, "use_clamp": clamp})
        for operation in math.MATH_OPERATIONS
        for clamp in ((False, True) if operation == "ADD" else (False,))
    ]


VECTORS = np.array(
    [
        (0, 0, 0), (1, 0, 0), (0.3, -0.7, 2.1), (-1.5, 0.25, -4), (0.5, 0.5, 0.5), (2, 0, -1), (-0.6, 0.48, 0.64),
        (7, -7, 0.1),
    ],
    np.float32,
)  # fmt: skip
COLORS = np.array(
    [
        (0, 0, 0), (1, 1, 1), (0.5, 0.5, 0.5), (0.8, 0.1, 0.2), (0.1, 0.7, 0.3), (0.2, 0.25, 0.9), (1, 0, 0), (0, 1, 1),
        (0.3, 0.6, 0.6), (0.6, 0.6, 0.1), (3, 0.5, 1.5), (-0.5, 0.4, 0.2), (0.9, -1, -2), (-1, -0.5, -2), (1.5, 1.5, 0),
    ],
    np.float32,
)  # fmt: skip
RANDOM = 400


def glsl_matrix(matrix: Matrix) -> str:
    """A matrix as a GLSL constant, column by column."""
    return f"mat4({', '.join(repr(float(matrix[row][column])) for column in range(4) for row in range(4))})"


SURFACE = f"""
struct Surface {{ vec3 viewer; bool backfacing; }};
struct Parameters {{ mat4 world_to_camera; vec3 world_origin; }};
const Parameters parameters = Parameters({glsl_matrix(CAMERA_MATRIX.inverted())}, vec3(0.0));
const mat4 TO_OBJECT = {glsl_matrix(OBJECT_MATRIX.inverted())}, TO_WORLD = {glsl_matrix(OBJECT_MATRIX)};
vec3 point_to_object(Surface surface, vec3 p) {{ return (TO_OBJECT * vec4(p, 1.0)).xyz; }}
vec3 direction_to_object(Surface surface, vec3 d) {{ return mat3(TO_OBJECT) * d; }}
vec3 direction_to_world(Surface surface, vec3 d) {{ return mat3(TO_WORLD) * d; }}
vec3 normal_to_world(Surface surface, vec3 n) {{ return n * mat3(TO_OBJECT); }}
vec3 normal_to_object(Surface surface, vec3 n) {{ return n * mat3(TO_WORLD); }}
"""
"""GLSL declarations that nodes need of shaders/materials/surface.glsl, for the samples of value_grids."""


def choices(*lists: np.ndarray) -> list[np.ndarray]:
    """All combinations of the lists' rows or numbers."""
    indices = np.meshgrid(*[np.arange(len(items)) for items in lists], indexing="ij")
    return [np.asarray(items, np.float32)[index.ravel()] for items, index in zip(lists, indices)]


def random_vectors(seed: int, low: float, high: float) -> np.ndarray:
    return np.random.default_rng(seed).uniform(low, high, (RANDOM, 3)).astype(np.float32)


def random_floats(seed: int, low: float, high: float) -> np.ndarray:
    return random_vectors(seed, low, high)[:, 0]


def vector_cases() -> list[Case]:
    a, b, c, scale = choices(VECTORS, VECTORS, VECTORS[1:4], (0.6, 1.4))
    inputs = {"vector": a, "vector_001": b, "vector_002": c, "scale": scale}
    cases = []
    for operation in math.VECTOR_OPERATIONS:
        output = "value" if operation in {"DOT_PRODUCT", "DISTANCE", "LENGTH"} else "vector"
        cases.append(case("vector_math", inputs, {"operation": operation}, outputs=(output,)))
    a, location, angles, scale = choices(VECTORS, VECTORS[1:5], VECTORS[1:6], [(1, 1, 1), (2, -0.5, 0.3), (0, 1.5, 1)])
    inputs = {"vector": a, "location": location, "rotation": angles, "scale": scale}
    for vector_type in KINDS["mapping"].options["vector_type"]:
        cases.append(case("mapping", inputs, {"vector_type": vector_type}))
    a, center, axis, angle, angles = choices(VECTORS, VECTORS[:3], VECTORS[:4], (-2.5, 0, 0.7, 9), VECTORS[2:5])
    inputs = {"vector": a, "center": center, "axis": axis, "angle": angle, "rotation": angles}
    for rotation_type in KINDS["vector_rotate"].options["rotation_type"]:
        for invert in BOOLEAN:
            cases.append(case("vector_rotate", inputs, {"rotation_type": rotation_type, "invert": invert}))
    return cases


def range_cases() -> list[Case]:
    value, low, high = grid(NUMBERS, FEW, FEW)
    inputs = {"value": value, "min": low, "max": high}
    cases = [case("clamp", inputs, {"clamp_type": kind}) for kind in KINDS["clamp"].options["clamp_type"]]
    lists = grid((-2, -0.5, 0, 0.2, 0.7, 1, 3.3), (-1, 0, 0.6), (-1, 0.5, 1), (0, 2), (-1.5, 1, 3), (0, 1, 4, 2.5, -2))
    vectors = [np.stack([values, np.roll(values, 1), np.roll(values, 7)], axis=-1) for values in lists]
    kinds = (("map_range", "FLOAT", lists), ("map_range_vector", "FLOAT_VECTOR", vectors))
    for interpolation in math.INTERPOLATIONS:
        for clamp in BOOLEAN:
            options = {"interpolation_type": interpolation, "clamp": clamp}
            for name, data_type, values in kinds:
                inputs = dict(zip(KINDS[name].inputs, values))
                cases.append(case(name, inputs, options, properties={"data_type": data_type}))
    return cases


def mix_cases() -> list[Case]:
    factor, a, b = choices((-0.5, 0, 0.3, 1, 1.6), VECTORS, VECTORS)
    factors = np.stack([factor, factor[::-1], np.roll(factor, 3)], axis=-1)
    kinds = (
        ("mix_float", (factor, a[:, 0], b[:, 2]), {"data_type": "FLOAT"}),
        ("mix_vector", (factor, a, b), {"data_type": "VECTOR"}),
        ("mix_vector_non_uniform", (factors, a, b), {"data_type": "VECTOR", "factor_mode": "NON_UNIFORM"}),
    )
    cases = []
    for clamp in BOOLEAN:
        for name, values, properties in kinds:
            inputs = dict(zip(KINDS[name].inputs, values))
            cases.append(case(name, inputs, {"clamp_factor": clamp}, properties=properties))
    factor, a, b = choices((-0.5, 0, 0.3, 1, 1.6), COLORS, COLORS)
    inputs = {"factor_float": factor, "a_color": a, "b_color": b}
    for blend_type in color.BLEND_TYPES:
        for clamp_factor, clamp_result in ((True, False), (False, False), (False, True)):
            options = {"blend_type": blend_type, "clamp_factor": clamp_factor, "clamp_result": clamp_result}
            cases.append(case("mix_color", inputs, options, properties={"data_type": "RGBA"}))
    inputs = {"fac": factor, "color1": a, "color2": b}
    for blend_type in color.BLEND_TYPES:
        for use_clamp in BOOLEAN:
            cases.append(case("mix_rgb", inputs, {"blend_type": blend_type, "use_clamp": use_clamp}))
    return cases


def color_cases() -> list[Case]:
    many = np.concatenate([COLORS, random_vectors(3, -0.5, 1.5)])
    a, factor = choices(many, (-0.5, 0, 0.4, 1, 2.2))
    a2, x, y = choices(many, (-1, 0, 0.4, 1, 2.2), (-1, 0, 0.4, 1, 2.2))
    hue = choices(COLORS, (-0.2, 0, 0.3, 0.5, 1, 1.7), (0, 0.5, 1, 3), (0, 0.7, 2), (-0.3, 0.5, 1))
    cases = [
        case("invert", {"fac": factor, "color": a}),
        case("gamma", {"color": a, "gamma": factor}),
        case("bright_contrast", {"color": a2, "bright": x, "contrast": y}),
        case("hue_saturation", dict(zip(("color", "hue", "saturation", "value", "fac"), hue))),
        case("rgb_to_bw", {"color": many}),
        case("separate_xyz", {"vector": many}),
        case("combine_xyz", dict(zip("xyz", many.T))),
    ]
    parts = np.concatenate([np.stack(grid((-0.3, 0, 0.1, 1 / 3, 0.5, 0.9, 1, 1.2), FEW, FEW), axis=-1), many])
    for mode in color.MODES:
        cases.append(case("separate_color", {"color": many}, {"mode": mode}))
        cases.append(case("combine_color", dict(zip(("red", "green", "blue"), parts.T)), {"mode": mode}))
    return cases


def set_ramp(interpolation: str, color_mode: str = "RGB") -> Callable:
    """Uneven stops, one hard edge and an alpha."""

    def prepare(node):
        ramp = node.color_ramp
        ramp.color_mode = color_mode
        if color_mode == "RGB":
            ramp.interpolation = interpolation
        else:
            ramp.hue_interpolation = interpolation
        ramp.elements[0].position, ramp.elements[0].color = 0.1, (0.9, 0.1, 0.2, 1.0)
        ramp.elements[1].position, ramp.elements[1].color = 0.83, (0.1, 0.3, 1.4, 0.2)
        for position, value in ((0.4, (0.2, 0.8, 0.1, 0.5)), (0.401, (0.0, 0.05, 0.02, 1.0))):
            ramp.elements.new(position).color = value

    return prepare


def set_stepped_hue(node: bpy.types.Node) -> None:
    """An interpolation that the user no longer sees, since the colors are mixed as HSV."""
    set_ramp("CONSTANT")(node)
    node.color_ramp.color_mode = "HSV"


def set_curves(extend: str) -> Callable:
    """Every curve gets points of its own, some outside the unit square."""

    def prepare(node):
        mapping = node.mapping
        mapping.use_clip = False
        mapping.extend = extend
        for index, curve in enumerate(mapping.curves):
            first, last = curve.points[0], curve.points[len(curve.points) - 1]
            first.location = (-0.2 * index, 0.1 - 0.1 * index)
            last.location = (1.0 + 0.1 * index, 0.9 + 0.2 * index)
            curve.points.new(0.3 + 0.1 * index, 0.7 - 0.15 * index)
            curve.points.new(0.62, 0.5).handle_type = "VECTOR"
        mapping.update()

    return prepare


def curve_cases() -> list[Case]:
    fac = {"fac": np.concatenate([np.linspace(-0.2, 1.2, 900), np.linspace(0.39, 0.41, 60), [0, 0.5, 1]])}
    cases = []
    for interpolation in ("LINEAR", "EASE", "B_SPLINE", "CARDINAL", "CONSTANT"):
        options = {"constant": interpolation == "CONSTANT"}
        cases.append(case("val_to_rgb", fac, options, prepare=set_ramp(interpolation), label=interpolation))
    for mode, hue in (("HSV", "NEAR"), ("HSL", "CW")):
        cases.append(case("val_to_rgb", fac, prepare=set_ramp(hue, mode), label=f"{mode} {hue}"))
    cases.append(case("val_to_rgb", fac, {"constant": True}, prepare=set_stepped_hue, label="HSV CONSTANT"))
    values, factor = random_vectors(5, -2.0, 2.5), random_floats(6, -0.2, 1.4)
    for extend in ("HORIZONTAL", "EXTRAPOLATED"):
        options, prepare = {"extrapolate": extend == "EXTRAPOLATED"}, set_curves(extend)
        cases += [
            case("rgb_curve", {"color": values, "fac": factor}, options, prepare=prepare),
            case("vector_curve", {"vector": values, "fac": factor}, options, prepare=prepare),
            case("float_curve", {"value": values[:, 0], "factor": factor}, options, prepare=prepare),
        ]
    return cases


def view_cases() -> list[Case]:
    cosine, x = grid(np.linspace(-1, 1, 21), (-0.5, 0, 0.3, 0.5, 0.7, 1, 1.3, 1.5, 2.4))
    normal = np.stack([np.sqrt(1 - cosine**2), 0 * cosine, cosine], axis=-1)
    cases = []
    for backfacing in BOOLEAN:
        cases.append(case("fresnel", {"ior": x, "normal": normal}, backfacing=backfacing))
        cases.append(case("layer_weight", {"blend": x, "normal": normal}, backfacing=backfacing))
    chosen = (0.36, 0.48, 0.8)

    def turn(node):
        node.outputs["Normal"].default_value = chosen

    inputs = {"normal": random_vectors(8, -2, 2), "direction": np.array([chosen])}
    cases.append(case("normal", inputs, prepare=turn, sockets={"direction": None}))
    strength, smooth = grid((0, 1, 30.5), (0, 0.5, 20))
    inputs = {"strength": strength, "smooth": smooth, "ray_length": np.array([RAY_LENGTH])}
    cases.append(case("light_falloff", inputs, sockets={"ray_length": None}))
    kind = KINDS["vector_transform"]
    for vector_type in kind.options["vector_type"]:
        for start in kind.options["convert_from"]:
            for end in kind.options["convert_to"]:
                options = {"vector_type": vector_type, "convert_from": start, "convert_to": end}
                # Cycles normalizes the normal 0 to NaN.
                vectors = VECTORS[1:] if vector_type == "NORMAL" else VECTORS
                cases.append(case("vector_transform", {"vector": vectors}, options))
    return cases


def spectrum_cases() -> list[Case]:
    """Ours and Cycles' blackbody are fits to Planck's law. What our observer's fit is off by is magnified by the
    conversion to RGB: (3.24 * 3e-3 + 1.54 * 1.5e-3 + 0.5 * 5e-3) / 2.52 = 6e-3 of white at most.
    """
    kelvins = np.concatenate([np.arange(0, 1000, 50), np.arange(1000, 14000, 100)])
    return [
        case("blackbody", {"temperature": kelvins}, relative=2e-3),
        case("wavelength", {"wavelength": np.arange(365.25, 790, 0.5)}, absolute=6e-3),
    ]


CASES = [
    *(*math_cases(), *vector_cases(), *range_cases(), *mix_cases()),
    *(*color_cases(), *curve_cases(), *view_cases(), *spectrum_cases()),
]


@pytest.fixture(scope="module")
def reference(registered):
    return cycles_values(CASES)


def test_every_option_is_covered():
    """Each value of each option is in some case."""
    assert {case.kind_name for case in CASES} == KINDS.keys()
    for name, kind in KINDS.items():
        for option, values in kind.options.items():
            tried = {case.options.get(option, values[0]) for case in CASES if case.kind_name == name}
            assert tried == set(values), f"{name}: {option}"


@pytest.mark.parametrize("number", range(len(CASES)), ids=[case.name for case in CASES])
def test_values(number, reference, context):
    assert_exported(CASES[number])
    with context.moderngl:
        ours = our_values(context, CASES[number], SURFACE)
    assert_values_agree(CASES[number], ours, reference[number])
