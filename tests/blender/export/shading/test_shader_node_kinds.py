# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of shader nodes have Blender's sockets, defaults and options."""

import pytest

bpy = pytest.importorskip("bpy")

import numpy as np  # noqa: E402

from rppm_addon.materials.nodes import shaders, volumes  # noqa: E402
from rppm_addon.materials.nodes.node_kinds import COLOR, FLOAT, VECTOR  # noqa: E402

KINDS = shaders.KINDS | {kind: node for kind, node in volumes.KINDS.items() if kind != "volume_boundary"}
BL_IDNAMES = {
    "emission": "ShaderNodeEmission",
    "background": "ShaderNodeBackground",
    "holdout": "ShaderNodeHoldout",
    "subsurface_scattering": "ShaderNodeSubsurfaceScattering",
    "bsdf_glossy": "ShaderNodeBsdfAnisotropic",
}
SOCKETS = {"RGBA": COLOR, "VALUE": FLOAT, "VECTOR": VECTOR}
IMPLICIT = {"normal", "position", "tangent"}


def name_of(socket) -> str:
    return socket.identifier.lower().replace(" ", "_")


NEWER = {"bsdf_principled": {"thin_wall"}}
"""Options that are sockets of later versions of Blender."""
NEWER_VALUES = {"RANDOM_WALK_LEGACY"}
"""Values of options that later versions have as well."""
OWN = {"color_grid", "density_grid", "temperature_grid", "coefficient", "mie_lobe"}
"""Inputs and options that Blender's nodes do not have."""
SHARING = {"mix_shader", "add_shader"}
"""Their shaders are no values."""


@pytest.mark.parametrize("kind", sorted(KINDS.keys() - SHARING))
def test_kinds_are_blenders(kind):
    bl_idname = BL_IDNAMES.get(kind) or "ShaderNode" + "".join(part.title() for part in kind.split("_"))
    material = bpy.data.materials.new(kind)
    if material.node_tree is None:
        material.use_nodes = True
    node = material.node_tree.nodes.new(bl_idname)
    named = [socket for socket in node.inputs if socket.identifier != "Weight" and socket.type != "STRING"]
    sockets = {name_of(socket): socket for socket in named}
    assert set(KINDS[kind].inputs) - OWN == set(sockets) - NEWER.get(kind, set())
    assert [name_of(socket) for socket in node.outputs] == list(KINDS[kind].outputs)
    for name, (socket_type, default) in KINDS[kind].inputs.items():
        if name in OWN:
            continue
        assert SOCKETS[sockets[name].type] is socket_type, name
        if isinstance(default, str):
            assert default in IMPLICIT
            assert not np.any(sockets[name].default_value), name
            continue
        value = np.ravel(sockets[name].default_value)[: 1 if socket_type is FLOAT else 3]
        np.testing.assert_allclose(value, np.broadcast_to(default, value.shape), atol=1e-3, err_msg=name)
    own = set(node.bl_rna.properties.keys()) - set(bpy.types.ShaderNode.bl_rna.properties.keys())
    assert own <= set(KINDS[kind].options)
    for name, values in KINDS[kind].options.items():
        if name in OWN or name in NEWER.get(kind, set()) - own:
            continue
        items = {item.identifier for item in node.bl_rna.properties[name].enum_items}
        assert set(values) - NEWER_VALUES == items - NEWER_VALUES, name
    bpy.data.materials.remove(material)
