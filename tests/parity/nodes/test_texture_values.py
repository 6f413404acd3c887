# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures: our GLSL gives the values of Cycles, for every option and for inputs at their extremes."""

import itertools

import numpy as np
import pytest

from rppm_addon.materials.nodes.node_kinds import BOOLEAN, FLOAT
from rppm_addon.materials.nodes.textures import KINDS

from ..net import material
from .names import blender_node
from .node_values import NodeCase, cycles_values, our_name, our_values

TOLERANCE = 1e-4
"""Absolute, or relative to values above 1: rounding of coordinates, magnified by the octaves."""
FLIPPED_SHARE = 0.005
"""Share of the pixels that may lie so near a border between cells that rounding puts them on the other side."""
AT_ONCE = 20
PERIODIC = {("tex_gabor", "phase")}
"""Outputs where 0 and 1 are the same."""
BRICK_PROPERTIES = {"offset", "offset_frequency", "squash", "squash_frequency"}
"""Properties of the node in Blender, inputs of our kind."""


def combinations(kind: str, inputs: list[dict], **options) -> list[NodeCase]:
    """All combinations of the options, all values of those not given, each with all sets of inputs."""
    values = {name: options.get(name, all_values) for name, all_values in KINDS[kind].options.items()}
    chosen = [dict(zip(values, combination)) for combination in itertools.product(*values.values())]
    return [NodeCase(blender_node(kind), choice, given) for choice in chosen for given in inputs]


def assert_equal_values(library, folder, kind: str, cases: list[NodeCase], shift=(0.0, 0.0, 0.0)) -> None:
    """Every output of every case is that of Cycles, but for flipped pixels."""
    failures, worst = [], 0.0
    for first in range(0, len(cases), AT_ONCE):
        some = cases[first : first + AT_ONCE]
        vector, w, expected = cycles_values(some, shift)
        for case, outputs in zip(some, expected):
            with library.context.moderngl:
                ours = our_values(library, folder, kind, KINDS[kind], case, vector, w)
            for name, values in outputs.items():
                difference = np.abs(ours[name].astype(np.float64) - values)
                if (kind, name) in PERIODIC:
                    difference = np.minimum(difference, 1.0 - difference)
                wrong = ~(difference <= TOLERANCE * np.maximum(1.0, np.abs(values))).reshape(len(w), -1).all(axis=1)
                worst = max(worst, wrong.mean())
                if wrong.mean() >= FLIPPED_SHARE:
                    failures.append(
                        f"{name} of {case.options} {case.inputs}: {wrong.mean():.2%} wrong, "
                        f"median difference {np.median(difference):.1e}, most {np.max(difference):.1e}"
                    )
    print(f"{kind}: {len(cases)} cases, at most {worst:.2%} of the pixels flipped")
    assert not failures, "\n".join(failures)


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_are_those_of_blender(kind):
    """Names and defaults of sockets, options and their values."""
    _, net = material("Kinds")
    node = net.tree.nodes.new(blender_node(kind))
    known = KINDS[kind]
    properties = BRICK_PROPERTIES if kind == "tex_brick" else set()
    assert known.inputs.keys() - properties == {our_name(socket.identifier) for socket in node.inputs}
    for socket in node.inputs:
        socket_type, default = known.inputs[our_name(socket.identifier)]
        assert (socket_type is FLOAT) == (socket.type == "VALUE")
        given = socket.default_value if socket_type is FLOAT else tuple(socket.default_value)[:3]
        of_kind = default if socket_type is FLOAT else default[: len(given)]  # Blender has vectors of two numbers
        assert np.allclose(given, of_kind, atol=1e-7), socket.identifier
    for name in properties:
        assert known.inputs[name][1] == getattr(node, name)
    assert [(our_name(s.identifier), s.type == "VALUE") for s in node.outputs] == [
        (name, socket_type is FLOAT) for name, socket_type in known.outputs.items()
    ]
    for name, values in known.options.items():
        described = node.bl_rna.properties[name]
        if values == BOOLEAN:
            assert described.type == "BOOLEAN"
        elif described.type == "INT":
            assert values == tuple(range(described.hard_min, described.hard_max + 1))
        else:
            assert set(values) == {item.identifier for item in described.enum_items}


# Fine octaves magnify the rounding of coordinates, so that those with an odd lacunarity have few.
NOISE_INPUTS = [
    {},
    {"scale": -3.7, "detail": 3.6, "roughness": 0.7, "lacunarity": 2.3, "offset": 0.4, "gain": 1.7},
    {"distortion": 1.3, "detail": 1.5, "offset": -0.3},
    {"scale": 2.0, "detail": 15.0, "roughness": 0.6, "gain": 5.0, "offset": 1.0},
    {"scale": 1e5, "detail": 1.0, "lacunarity": 1.7},
    {"scale": 1e8, "detail": 0.0},
]


NOISE_EXTREMES = [
    {"lacunarity": 0.0}, {"roughness": 0.0}, {"detail": 0.0}, {"detail": 7.5, "roughness": 1.0}, {"scale": 0.0},
]  # fmt: skip


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_noise(library, tmp_path, dimensions):
    chosen = {"noise_dimensions": (dimensions,)}
    cases = combinations("tex_noise", NOISE_INPUTS, **chosen, normalize=(True,))
    cases += combinations("tex_noise", NOISE_INPUTS[:2], **chosen, noise_type=("FBM",), normalize=(False,))
    octaves = chosen | {"noise_type": ("FBM", "HYBRID_MULTIFRACTAL"), "normalize": (True,)}
    cases += combinations("tex_noise", NOISE_EXTREMES, **octaves)
    assert_equal_values(library, tmp_path, "tex_noise", cases)


VORONOI_INPUTS = [
    {"exponent": 0.7},
    {
        "scale": -2.3, "detail": 1.6, "roughness": 0.7, "lacunarity": 2.3, "smoothness": 0.6, "exponent": 1.7,
        "randomness": 0.8,
    },
]  # fmt: skip
VORONOI_EXTREMES = [
    {"smoothness": 0.0},
    {"randomness": 0.0, "smoothness": 0.0},
    {"randomness": 0.0},
    {"roughness": 0.0, "detail": 3.5},
    {"roughness": 1.0, "detail": 6.0},
    {"lacunarity": 0.5, "detail": 4.0},
    {"scale": 0.0},
    {"scale": 1e4},
    {"scale": -1e6},
]


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", pytest.param("4D", marks=pytest.mark.long)])
def test_voronoi(library, tmp_path, dimensions):
    chosen = {"voronoi_dimensions": (dimensions,)}
    cases = combinations("tex_voronoi", VORONOI_INPUTS, **chosen, feature=("F1", "F2", "SMOOTH_F1"), normalize=(True,))
    cases += combinations("tex_voronoi", VORONOI_INPUTS, **chosen, distance=("EUCLIDEAN",), normalize=(False,))
    minkowski = chosen | {"distance": ("MINKOWSKI",), "feature": ("F1", "F2")}
    cases += combinations("tex_voronoi", [{"exponent": 0.2}, {"exponent": 5.0}], **minkowski, normalize=(True,))
    cases += combinations("tex_voronoi", VORONOI_EXTREMES, **chosen, distance=("EUCLIDEAN",), normalize=(True,))
    assert_equal_values(library, tmp_path, "tex_voronoi", cases)


WAVE_INPUTS = [
    {},
    {
        "scale": -1.3, "distortion": 2.5, "detail": 2.6, "detail_scale": 1.7, "detail_roughness": 0.7,
        "phase_offset": 1.1,
    },
]  # fmt: skip


@pytest.mark.parametrize("profile", ["SIN", "SAW", "TRI"])
def test_wave(library, tmp_path, profile):
    bands = {"wave_type": ("BANDS",), "rings_direction": ("X",), "wave_profile": (profile,)}
    rings = {"wave_type": ("RINGS",), "bands_direction": ("X",), "wave_profile": (profile,)}
    cases = combinations("tex_wave", WAVE_INPUTS, **bands) + combinations("tex_wave", WAVE_INPUTS, **rings)
    assert_equal_values(library, tmp_path, "tex_wave", cases)


def test_magic(library, tmp_path):
    cases = combinations("tex_magic", [{}, {"scale": -1.7, "distortion": 1.6}, {"distortion": 0.0}])
    assert_equal_values(library, tmp_path, "tex_magic", cases)


def test_magic_far_away(library, tmp_path):
    """Coordinates are wrapped before they are scaled."""
    cases = combinations("tex_magic", [{"scale": 1.0}], turbulence_depth=(0, 2, 10))
    assert_equal_values(library, tmp_path, "tex_magic", cases, shift=(300.0, -200.0, 1000.0))


def test_gradient(library, tmp_path):
    assert_equal_values(library, tmp_path, "tex_gradient", combinations("tex_gradient", [{}]))


def test_checker(library, tmp_path):
    inputs = [{}, {"scale": -7.3, "color1": (0.1, 0.2, 0.3), "color2": (2.0, 0.0, 0.7)}, {"scale": 1e3}]
    assert_equal_values(library, tmp_path, "tex_checker", combinations("tex_checker", inputs))


BRICK_INPUTS = [
    {},
    {
        "scale": -2.3, "bias": 0.3, "mortar_size": 0.05, "mortar_smooth": 0.6, "brick_width": 0.8, "row_height": 0.3,
        "color1": (0.9, 0.2, 0.1), "color2": (0.1, 0.8, 0.5), "mortar": (0.0, 0.4, 1.0),
        "offset": 0.3, "offset_frequency": 3, "squash": 1.6, "squash_frequency": 2,
    },
    {"scale": 50.0, "mortar_smooth": 0.0, "bias": -0.5},
    {"scale": 3.0, "mortar_size": 0.125, "mortar_smooth": 1.0, "offset_frequency": 1, "squash": 0.4},
]  # fmt: skip


def test_brick(library, tmp_path):
    assert_equal_values(library, tmp_path, "tex_brick", combinations("tex_brick", BRICK_INPUTS))


def test_white_noise(library, tmp_path):
    assert_equal_values(library, tmp_path, "tex_white_noise", combinations("tex_white_noise", [{}]))


TILES = [
    {"sides": sides, "roundness": roundness}
    for sides, roundnesses in {
        0.5: (0.0, 1.0),  # counts as 2, of which Cycles rounds no corners in a way that could be seen
        3.0: (0.0, 0.3, 1.0),
        5.0: (0.0, 0.7, 2.0),
        2.6: (0.0, 0.4, 1.0),
        7.3: (0.0, 0.2, 0.8, 1.0),
        12.9: (0.5,),
    }.items()
    for roundness in roundnesses
]


def test_radial_tiling(library, tmp_path):
    assert_equal_values(library, tmp_path, "radial_tiling", combinations("radial_tiling", TILES))


GABOR_INPUTS = [
    {},
    {"scale": -3.1, "frequency": 1.3, "anisotropy": 0.3, "orientation_2d": -0.4, "orientation_3d": (0.3, -0.5, 0.2)},
    {"scale": 100.0, "anisotropy": 0.0},
    {"frequency": 0.0, "anisotropy": 2.0, "orientation_3d": (0.0, 0.0, -2.0)},
]


def test_gabor(library, tmp_path):
    assert_equal_values(library, tmp_path, "tex_gabor", combinations("tex_gabor", GABOR_INPUTS))


def test_gabor_along_z_is_finite(library, tmp_path):
    """Cycles divides zero by zero where directions turned at random start from the z axis."""
    case = NodeCase(
        blender_node("tex_gabor"), {"gabor_type": "3D"}, {"anisotropy": 0.5, "orientation_3d": (0.0, 0.0, 1.0)}
    )
    coordinates = np.random.default_rng(1).uniform(-3.0, 3.0, (4096, 3)).astype(np.float32)
    with library.context.moderngl:
        ours = our_values(library, tmp_path, "tex_gabor", KINDS["tex_gabor"], case, coordinates, coordinates[:, 0])
    assert all(np.isfinite(values).all() and np.ptp(values) > 0.5 for values in ours.values())
