# SPDX-License-Identifier: GPL-3.0-or-later
"""More emissive triangles than a device has room for."""

import dataclasses

import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.lights.emitters import candidates
from rppm_addon.integrator.lights.light_tree import LightTree
from rppm_addon.scene.errors import DeviceError
from rppm_addon.self_test.meshes import placed

GLOW = material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 0.5, 0.2)))


def test_too_many_emitters_are_refused_before_they_are_asked(mapper, monkeypatch):
    """With the objects that have the most; triangles that do not emit do not count, nor are any counted in vain."""
    scene = scenes.room(8, photons=64)
    scene.materials.append(GLOW)
    glowing = len(scene.materials) - 1
    ball = scene.meshes[5].triangle_count
    for number, name in enumerate(["lamp", "moss", "moss"]):
        instance = dataclasses.replace(scene.instances[5], matrix=placed(0.2 * number, 0.0, 0.5, 0.1))
        scene.instances.append(dataclasses.replace(instance, materials=[glowing], object_name=name))
    asked = []
    refuse = LightTree.refuse
    monkeypatch.setattr(LightTree, "refuse", lambda tree, *counts: asked.append(counts) or refuse(tree, *counts))
    mapper.build(scene)
    assert asked == [(1, mapper.triangle_count)]
    nodes = mapper.device_scene.lights._light_tree.nodes
    assert nodes.size == 64 * 2 * (3 * ball + 1)  # of the tree, and of that of the light under the ceiling
    asked.clear()
    mapper.device_scene.forget()
    monkeypatch.setattr(type(nodes), "limit", nodes.size + 64)  # and a place for a sun
    mapper.build(scene)
    assert asked == [(1, mapper.triangle_count), (1, 3 * ball)]
    mapper.device_scene.forget()
    monkeypatch.setattr(type(nodes), "limit", nodes.size - 1)
    monkeypatch.setattr(type(mapper.device_scene.lights.emitters), "build", lambda *_: pytest.fail("asked"))
    most = f'{2 * ball:,} of "moss", {ball} of "lamp".$'
    said = f"light tree needs .* let fewer triangles emit .* .of {3 * ball:,} that do, .* {most}"
    with pytest.raises(DeviceError, match=said):
        mapper.build(scene)
    monkeypatch.setattr(type(nodes), "limit", nodes.size + 64)
    monkeypatch.setattr(candidates, "STEPS", 3 * ball - 1)
    with pytest.raises(DeviceError, match=f"no more than {3 * ball - 1:,} triangles can emit light; let .* {most}"):
        mapper.build(scene)
