# SPDX-License-Identifier: GPL-3.0-or-later
"""Image textures on colors, and what happens where an image is missing."""

import os

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, export, export_graph, new_image, save_png
from cycles_light import cycles_radiance
from node_trees import add_node, added, link, shaders, source, surface, to_surface

from rppm_addon.blender.export.images import kept_images
from rppm_addon.blender.export.images.color_spaces import scene_linear
from rppm_addon.blender.export.images.images import MISSING
from rppm_addon.blender.export.images.multilayer import PassSelection
from rppm_addon.scene.common.working_space import WORKING_SPACES
from rppm_addon.scene.images import encode_srgb


def textured(image, socket="Color", shader="ShaderNodeBsdfDiffuse", output="Color"):
    material, node = surface(shader)
    texture = add_node(material.node_tree, "ShaderNodeTexImage", "Picture", image=image)
    link(material.node_tree, texture.outputs[output], node.inputs[socket])
    return material


def exported_image(scene, material):
    add_mesh(scene, material=material)
    exported = export(scene)
    (texture,) = (node for node in exported.materials[0].graph.nodes if node.kind == "tex_image")
    return exported.images[texture.image], texture, exported.warnings


PIXELS = np.linspace(0.0, 1.0, 3 * 5 * 4).reshape(3, 5, 4)
PIXELS[..., 3] = 1.0


def test_byte_images_keep_their_encoding(scene):
    image, texture, warnings = exported_image(scene, textured(new_image("Byte", PIXELS)))
    assert texture.name == "Picture"
    assert image.name == "Byte" and image.encoding == "SRGB" and image.pixels.dtype == np.uint8
    np.testing.assert_allclose(image.pixels, PIXELS * 255.0, atol=0.51)
    assert warnings == []


def test_float_images_are_linear(scene):
    image, _, warnings = exported_image(scene, textured(new_image("Float", PIXELS * 7.0, is_float=True)))
    assert image.encoding == "LINEAR" and image.pixels.dtype == np.float32
    np.testing.assert_allclose(image.pixels, PIXELS * 7.0, atol=1e-5)
    assert warnings == []


@pytest.mark.skipif(not hasattr(bpy.data, "colorspace"), reason="before Blender 5.0 all files have one working space")
@pytest.mark.parametrize("name", ["ACEScg", "Linear Rec.2020"])
def test_images_are_of_the_working_space(scene, name):
    assert export(scene).working_space == "Linear Rec.709"
    bpy.ops.wm.set_working_color_space(working_space=name)
    red = np.zeros((2, 2, 4)) + (1.0, 0.0, 0.0, 1.0)
    image, _, _ = exported_image(scene, textured(new_image("Red", red)))
    assert image.encoding == "LINEAR" and export(scene).working_space == name
    np.testing.assert_allclose(image.pixels[0, 0, :3], WORKING_SPACES[name].from_rec709(red[0, 0, :3]), atol=2e-3)


def test_data_images_are_not_decoded(scene):
    image, _, _ = exported_image(scene, textured(new_image("Data", PIXELS, space="Non-Color")))
    assert image.encoding == "LINEAR" and image.pixels.dtype == np.uint8


def test_rows_run_from_the_bottom(scene):
    pixels = np.zeros((2, 1, 4))
    pixels[:, 0] = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)
    image, _, _ = exported_image(scene, textured(new_image("Rows", pixels)))
    assert image.pixels[0, 0, 0] == 255 and image.pixels[1, 0, 1] == 255


def test_saved_and_packed_images_agree(scene, material, tree, tmp_path):
    save_png(new_image("Saved", PIXELS), tmp_path / "saved.png")
    images = [bpy.data.images.load(str(tmp_path / "saved.png"), check_existing=False) for _ in range(2)]
    images[1].pack()
    textures = (add_node(tree, "ShaderNodeTexImage", image=image).outputs["Color"] for image in images)
    to_surface(material, added(tree, *(add_node(tree, "ShaderNodeBsdfDiffuse", Color=color) for color in textures)))
    add_mesh(scene, material=material)
    exported = export(scene)
    assert len(exported.images) == 2
    np.testing.assert_array_equal(exported.images[0].pixels, exported.images[1].pixels)
    np.testing.assert_allclose(exported.images[0].pixels, PIXELS * 255.0, atol=0.51)


def test_files_are_read_again_when_they_may_have_changed(scene, tmp_path, monkeypatch):
    """In a window, where pixels are kept."""
    monkeypatch.setattr(kept_images, "_is_keeping", True)
    path = str(tmp_path / "kept.png")

    def save(pixels):
        made = new_image("Made", pixels)
        save_png(made, path)
        bpy.data.images.remove(made)

    save(PIXELS)
    image = bpy.data.images.load(path)
    add_mesh(scene, material=textured(image))
    first = export(scene).images[0]
    assert export(scene).images[0] is first
    flipped = PIXELS[::-1].copy()
    save(flipped)
    os.utime(path, ns=(1, 1))
    image.reload()
    second = export(scene).images[0]
    np.testing.assert_allclose(second.pixels, flipped * 255.0, atol=0.51)
    image.pixels.foreach_set(PIXELS.astype(np.float32).reshape(-1))
    third = export(scene).images[0]
    np.testing.assert_allclose(third.pixels, PIXELS * 255.0, atol=0.51)
    image.reload()
    image.colorspace_settings.name = "Non-Color"
    assert export(scene).images[0].encoding == "LINEAR"
    assert export(scene).images[0] is export(scene).images[0]
    kept_images.unregister()
    kept_images.register()
    assert kept_images.kept(image, PassSelection()) is None


def test_an_image_used_twice_is_exported_once(scene):
    image = new_image("Shared", PIXELS)
    for name in ("First", "Second"):
        add_mesh(scene, name, material=textured(image))
    exported = export(scene)
    assert len(exported.images) == 1 and len(exported.materials) == 2


def test_an_image_on_two_inputs_is_one_node(scene):
    material = textured(new_image("Image", PIXELS), "Base Color", "ShaderNodeBsdfPrincipled")
    tree = material.node_tree
    principled = tree.nodes["Principled BSDF"]
    link(tree, tree.nodes["Picture"].outputs["Color"], principled.inputs["Emission Color"])
    link(tree, tree.nodes["Picture"].outputs["Alpha"], principled.inputs["Alpha"])
    graph, warnings = export_graph(scene, material)
    ((shader, _),) = shaders(graph)
    links = [shader.inputs[name] for name in ("base_color", "emission_color", "alpha")]
    assert len({found.node for found in links}) == 1
    assert [found.output for found in links] == ["color", "color", "alpha"]
    assert warnings == []


def test_a_file_that_is_no_picture(scene, tmp_path):
    """It is there: looking for it would not help."""
    path = tmp_path / "damaged.png"
    path.write_bytes(b"\x89PNG and no more")
    image = bpy.data.images.new("damaged.png", 4, 4)
    image.source, image.filepath = "FILE", str(path)
    add_mesh(scene, material=textured(image))
    (text,) = export(scene).warnings
    assert "damaged.png" in text and "cannot read" in text and "save it anew" in text and "missing" not in text.lower()


@pytest.mark.parametrize("has_image", [False, True])
def test_missing_images_are_named(scene, tmp_path, has_image):
    image = new_image("Lost", PIXELS) if has_image else None
    if has_image:
        image.source, image.filepath = "FILE", str(tmp_path / "nowhere.png")
    graph, warnings = export_graph(scene, textured(image))
    ((shader, _),) = shaders(graph)
    assert source(graph, shader, "color").image == MISSING
    named = ('"Material"', '"Lost"', "nowhere.png") if has_image else ('"Picture"',)
    assert any(all(name in text for name in named) for text in warnings)


def test_placement_by_a_mapping(scene):
    material = textured(new_image("Image", PIXELS))
    tree = material.node_tree
    place = add_node(tree, "ShaderNodeTexCoord").outputs["UV"]
    mapping = add_node(tree, "ShaderNodeMapping", "Shift", Location=(0.25, 0.5, 0.0), Vector=place)
    link(tree, mapping.outputs[0], tree.nodes["Picture"].inputs["Vector"])
    graph, warnings = export_graph(scene, material)
    (texture,) = (node for node in graph.nodes if node.kind == "tex_image")
    placed = source(graph, texture, "vector")
    assert (placed.kind, placed.name, placed.inputs["location"]) == ("mapping", "Shift", (0.25, 0.5, 0.0))
    assert graph.nodes[placed.inputs["vector"].node].kind == "tex_coord" and warnings == []


@pytest.mark.parametrize("space", ["sRGB", "Non-Color"])
@pytest.mark.parametrize("alpha_mode", ["STRAIGHT", "CHANNEL_PACKED", "NONE"])
@pytest.mark.parametrize("linked", [False, True])
def test_transparent_colors_are_those_of_cycles(scene, tmp_path, space, alpha_mode, linked):
    save_png(new_image("Saved", np.full((4, 4, 4), (1.0, 0.5, 0.25, 0.5))), tmp_path / "alpha.png")
    image = bpy.data.images.load(str(tmp_path / "alpha.png"))
    image.alpha_mode, image.colorspace_settings.name = alpha_mode, space
    material = textured(image, shader="ShaderNodeEmission")
    tree = material.node_tree
    if linked:  # to a strength of 1, whatever the alpha is
        # MAXIMUM: what Cycles could do without at once would not count as linked
        alpha = tree.nodes["Picture"].outputs["Alpha"]
        greater = add_node(tree, "ShaderNodeMath", operation="MAXIMUM", Value=alpha)
        greater.inputs[1].default_value = 1.0
        link(tree, greater.outputs[0], tree.nodes["Emission"].inputs["Strength"])
    add_mesh(scene, material=material).data.uv_layers.new()
    exported = export(scene)
    (picture,) = exported.images
    (texture,) = (node for node in exported.materials[0].graph.nodes if node.kind == "tex_image")
    color = picture.pixels[0, 0, :3] / 255.0
    if texture.options["unassociate"]:  # the texture's program divides before it decodes
        color = color / (picture.pixels[0, 0, 3] / 255.0)
    if picture.encoding == "SRGB":
        color = np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(color, cycles_radiance(scene, tmp_path), atol=3e-3)


def test_pixels_that_are_not_finite(scene):
    pixels = PIXELS.copy()
    pixels[0, 0, 0], pixels[0, 1, 1] = np.nan, np.inf
    image, _, _ = exported_image(scene, textured(new_image("Broken", pixels, is_float=True)))
    assert np.isfinite(image.pixels).all()


def test_movies(scene, tmp_path):
    """The picture of the frame, from a copy that does not stay; a movie that is gone is missing."""
    from PIL import Image

    pictures = [Image.new("RGB", (4, 2), (50 * number, 20, 0)) for number in range(4)]
    pictures[0].save(tmp_path / "shot.gif", save_all=True, append_images=pictures[1:], duration=40)
    movie = bpy.data.images.load(str(tmp_path / "shot.gif"))
    movie.source = "MOVIE"
    material = textured(movie)
    node = next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    node.image_user.frame_duration, node.image_user.frame_start = 4, 10
    scene.frame_set(12)
    image, _, warnings = exported_image(scene, material)
    assert warnings == [] and len(bpy.data.images) == 1
    np.testing.assert_array_equal(image.pixels[0, 0], (100, 20, 0, 255))
    movie.filepath = str(tmp_path / "gone.gif")
    assert any('"Picture"' in text and "gone.gif" in text for text in export(scene).warnings)


SPACES = ["Linear Rec.2020", "ACEScg", "ACES2065-1", "Display P3", "Rec.1886", "Khronos PBR Neutral sRGB"]


@pytest.mark.parametrize("space", SPACES)
def test_gray_is_gray_in_all_spaces(scene, space):
    gray = scene_linear(np.full((2, 3, 3), 0.4), space)
    assert gray == pytest.approx(np.broadcast_to(gray[0, 0, 0], (2, 3, 3)), rel=1e-3)


def test_places_of_colors_stay(scene):
    """From bytes as from floats: Blender decodes both alike."""
    colors = np.random.default_rng(3).random((3, 4, 3))
    assert encode_srgb(scene_linear(colors, "sRGB")) == pytest.approx(colors, abs=1e-5)
    assert len(bpy.data.images) == 0


@pytest.mark.timeout(60)
@pytest.mark.parametrize("source_kind", ["FILE", "SEQUENCE"])
def test_a_pipe_is_no_image(scene, tmp_path, source_kind):
    """Who opened it would wait for ever for somebody that writes."""
    os.mkfifo(tmp_path / "pipe_0001.png")
    image = bpy.data.images.new("Pipe", 1, 1)
    image.source, image.filepath = source_kind, str(tmp_path / "pipe_0001.png")
    add_mesh(scene, material=textured(image))
    assert any("pipe_0001.png" in text and "is missing" in text for text in export(scene).warnings)
