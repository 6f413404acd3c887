# SPDX-License-Identifier: GPL-3.0-or-later
"""References of Cycles' side: exact where tests compare, found by the scene alone, and checked against Cycles."""

import bpy
import numpy as np
import pytest

from . import references
from .comparison import block_means
from .engines import render_cycles
from .scene_digest import scene_digest
from .scenes import DIFFUSE, GLASS, ball, camera, light, material, new_scene, place, plane


def pictures(seed: int, level: float = 1.0) -> np.ndarray:
    """(2, 16, 24, 4) noisy pictures with black parts, an even alpha, and values over six decades."""
    generator = np.random.default_rng(seed)
    mean = np.exp(np.linspace(-7.0, 7.0, 16 * 24 * 3)).reshape(16, 24, 3)
    found = np.ones((2, 16, 24, 4))
    found[..., :3] = level * mean * generator.gamma(100.0, 0.01, (2, 16, 24, 3))
    found[:, 3, :, :3] = 0.0
    return found


def test_means_of_blocks_are_kept_and_detail_roughly():
    given = pictures(1)
    kept = references.unpacked(references.packed(given))
    np.testing.assert_allclose(block_means(kept[..., :3]), block_means(given[..., :3]), rtol=1e-6)
    np.testing.assert_array_equal(kept[..., 3], 1.0)
    np.testing.assert_array_equal(kept == 0.0, given == 0.0)
    # Four bits, and five sigmas of a seed beside the mean of both.
    bright = given[..., :3] > 1e-4 * given.max()
    np.testing.assert_allclose(kept[..., :3][bright], given[..., :3][bright], rtol=0.5)


def test_comparing_takes_noise_and_nothing_else():
    kept = references.unpacked(references.packed(pictures(1)))
    references.compare(pictures(1), kept, "file")
    references.compare(pictures(2), kept, "file")
    with pytest.raises(AssertionError, match="make references"):
        references.compare(pictures(2, 1.2), kept, "file")


def build() -> bpy.types.Scene:
    scene = new_scene(world=0.2)
    plane(3.0, material(DIFFUSE, Color=(0.8, 0.7, 0.6)))
    ball(0.5, material(GLASS), segments=8)
    light("AREA", 10.0, place(at=(0.0, 0.0, 3.0)), size=0.5)
    camera((0.0, -1.0, 6.0), (0.0, 0.0, 0.0))
    return scene


def _change_node(scene):
    bpy.data.materials[0].node_tree.nodes[0].inputs["Roughness"].default_value = 0.25


def _unlink(scene):
    links = bpy.data.materials[0].node_tree.links
    links.remove(links[0])


def _move_vertex(scene):
    bpy.data.meshes[0].vertices[0].co.x += 0.001


def _image(scene):
    bpy.data.images.new("Image", 2, 2).pixels[0] = 0.5


CHANGES = {
    "light": lambda scene: setattr(bpy.data.lights[0], "energy", 10.01),
    "place": lambda scene: setattr(scene.camera.location, "x", 0.001),
    "node": _change_node,
    "link": _unlink,
    "vertex": _move_vertex,
    "image": _image,
    "visibility": lambda scene: setattr(bpy.data.objects[0], "visible_shadow", False),
    "Cycles": lambda scene: setattr(scene.cycles, "max_bounces", 3),
    "filter": lambda scene: setattr(scene.cycles, "filter_width", 1.4),
    "shutter": lambda scene: setattr(scene.render, "use_motion_blur", True),
    "resolution": lambda scene: setattr(scene.render, "resolution_x", 65),
    "film": lambda scene: setattr(scene.render, "film_transparent", True),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
def test_a_change_of_the_scene_is_noticed(change):
    scene = build()
    before = scene_digest()
    change(scene)
    assert scene_digest() != before
    build()
    assert scene_digest() == before


def test_what_windows_show_changes_nothing(registered):
    scene = build()
    before = scene_digest()
    bpy.data.objects[0].select_set(True)
    scene.render.filepath = "/elsewhere"
    scene.rppm.samples += 1
    bpy.context.view_layer.update()
    assert scene_digest() == before


@pytest.fixture
def kept(monkeypatch, tmp_path):
    """References are used, of an empty folder for this Blender."""
    mode = references.mode()
    monkeypatch.setattr(references, "FOLDER", tmp_path)
    (tmp_path / "blender_version.txt").write_text(bpy.app.version_string)
    references.use(references.Mode.KEPT)
    yield tmp_path
    references.use(mode)


def test_a_scene_of_which_nothing_is_kept_says_how_to_keep_it(kept):
    build()
    with pytest.raises(references.ReferenceMissing, match="make references TESTS=tests/parity/test_references.py"):
        render_cycles(samples=2)


def test_another_blender_renders_for_itself(kept):
    (kept / "blender_version.txt").write_text("another")
    build()
    assert render_cycles(samples=2, seeds=1).shape == (1, 64, 64, 3)
