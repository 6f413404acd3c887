# SPDX-License-Identifier: GPL-3.0-or-later
"""Arithmetic on numbers and vectors, ranges, and rotations."""

from ...gl.buffers.constants import Constants
from .node_kinds import BOOLEAN, FLOAT, VECTOR, NodeKind

ZERO, ONE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)

MATH_OPERATIONS = (
    "ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "POWER", "LOGARITHM", "SQRT", "INVERSE_SQRT",
    "ABSOLUTE", "EXPONENT", "MINIMUM", "MAXIMUM", "LESS_THAN", "GREATER_THAN", "SIGN", "COMPARE", "SMOOTH_MIN",
    "SMOOTH_MAX", "ROUND", "FLOOR", "CEIL", "TRUNC", "FRACT", "MODULO", "FLOORED_MODULO", "WRAP", "SNAP", "PINGPONG",
    "SINE", "COSINE", "TANGENT", "ARCSINE", "ARCCOSINE", "ARCTANGENT", "ARCTAN2", "SINH", "COSH", "TANH", "RADIANS",
    "DEGREES",
)  # fmt: skip

VECTOR_OPERATIONS = (
    "ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "CROSS_PRODUCT", "PROJECT", "REFLECT", "REFRACT",
    "FACEFORWARD", "DOT_PRODUCT", "DISTANCE", "LENGTH", "SCALE", "NORMALIZE", "ABSOLUTE", "POWER", "SIGN", "MINIMUM",
    "MAXIMUM", "FLOOR", "CEIL", "FRACTION", "MODULO", "WRAP", "SNAP", "SINE", "COSINE", "TANGENT",
)  # fmt: skip

INTERPOLATIONS = ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP")
_CLAMP_TYPES = ("MINMAX", "RANGE")
_MAPPING_TYPES = ("POINT", "TEXTURE", "VECTOR", "NORMAL")
_ROTATION_TYPES = ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ")
Constants("RangeOptions", CLAMP=_CLAMP_TYPES, RANGE=INTERPOLATIONS)
Constants("MappingOptions", MAPPING=_MAPPING_TYPES, ROTATE=_ROTATION_TYPES)

KINDS = {
    "math": NodeKind(
        "math.glsl",
        {"value": (FLOAT, 0.5), "value_001": (FLOAT, 0.5), "value_002": (FLOAT, 0.5)},
        {"value": FLOAT},
        {"operation": MATH_OPERATIONS, "use_clamp": BOOLEAN},
        function_option="operation",
    ),
    "vector_math": NodeKind(
        "vector_math.glsl",
        {"vector": (VECTOR, ZERO), "vector_001": (VECTOR, ZERO), "vector_002": (VECTOR, ZERO), "scale": (FLOAT, 1.0)},
        {"vector": VECTOR, "value": FLOAT},
        {"operation": VECTOR_OPERATIONS},
        function_option="operation",
    ),
    "mix_float": NodeKind(
        "mix.glsl",
        {"factor_float": (FLOAT, 0.5), "a_float": (FLOAT, 0.0), "b_float": (FLOAT, 0.0)},
        {"result_float": FLOAT},
        {"clamp_factor": BOOLEAN},
    ),
    "mix_vector": NodeKind(
        "mix.glsl",
        {"factor_float": (FLOAT, 0.5), "a_vector": (VECTOR, ZERO), "b_vector": (VECTOR, ZERO)},
        {"result_vector": VECTOR},
        {"clamp_factor": BOOLEAN},
    ),
    "mix_vector_non_uniform": NodeKind(
        "mix.glsl",
        {"factor_vector": (VECTOR, (0.5, 0.5, 0.5)), "a_vector": (VECTOR, ZERO), "b_vector": (VECTOR, ZERO)},
        {"result_vector": VECTOR},
        {"clamp_factor": BOOLEAN},
    ),
    "clamp": NodeKind(
        "range.glsl",
        {"value": (FLOAT, 1.0), "min": (FLOAT, 0.0), "max": (FLOAT, 1.0)},
        {"result": FLOAT},
        {"clamp_type": _CLAMP_TYPES},
    ),
    "map_range": NodeKind(
        "range.glsl",
        {
            "value": (FLOAT, 1.0),
            "from_min": (FLOAT, 0.0),
            "from_max": (FLOAT, 1.0),
            "to_min": (FLOAT, 0.0),
            "to_max": (FLOAT, 1.0),
            "steps": (FLOAT, 4.0),
        },
        {"result": FLOAT},
        {"interpolation_type": INTERPOLATIONS, "clamp": BOOLEAN},
    ),
    "map_range_vector": NodeKind(
        "range.glsl",
        {
            "vector": (VECTOR, ZERO),
            "from_min_float3": (VECTOR, ZERO),
            "from_max_float3": (VECTOR, ONE),
            "to_min_float3": (VECTOR, ZERO),
            "to_max_float3": (VECTOR, ONE),
            "steps_float3": (VECTOR, (4.0, 4.0, 4.0)),
        },
        {"vector": VECTOR},
        {"interpolation_type": INTERPOLATIONS, "clamp": BOOLEAN},
    ),
    "mapping": NodeKind(
        "mapping.glsl",
        {"vector": (VECTOR, ZERO), "location": (VECTOR, ZERO), "rotation": (VECTOR, ZERO), "scale": (VECTOR, ONE)},
        {"vector": VECTOR},
        {"vector_type": _MAPPING_TYPES},
    ),
    "vector_rotate": NodeKind(
        "mapping.glsl",
        {
            "vector": (VECTOR, ZERO),
            "center": (VECTOR, ZERO),
            "axis": (VECTOR, (0.0, 0.0, 1.0)),
            "angle": (FLOAT, 0.0),
            "rotation": (VECTOR, ZERO),
        },
        {"vector": VECTOR},
        {"rotation_type": _ROTATION_TYPES, "invert": BOOLEAN},
    ),
}
