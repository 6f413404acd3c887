# SPDX-License-Identifier: GPL-3.0-or-later
"""--set PATH=VALUE on Blender's data."""

import math

import pytest

from rppm_addon.commands.blend_files.data_paths import set_data_path, split_assignment
from rppm_addon.scene.errors import SettingsError

bpy = pytest.importorskip("bpy", reason="the bpy module is not installed")


PRINCIPLED = 'materials["Material"].node_tree.nodes["Principled BSDF"].inputs'


def principled(place):
    return bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs[place].default_value


@pytest.fixture
def roots():
    bpy.ops.wm.read_factory_settings(use_empty=False)
    scene = bpy.context.scene
    scene.objects["Light"].name = 'A "light" = b'
    scene["mine"] = 1.5
    return scene, bpy.data


@pytest.mark.parametrize(
    ("text", "path", "value"),
    [
        ("rppm.alpha=0.6", "rppm.alpha", "0.6"),
        ('objects["a=b"].data.energy = 5', 'objects["a=b"].data.energy', "5"),
        (r'objects["a\"=b"].name=x=y', r'objects["a\"=b"].name', "x=y"),
        ("render.filepath=", "render.filepath", ""),
    ],
)
def test_an_assignment_is_split_outside_of_quotes(text, path, value):
    assert split_assignment(text) == (path, value)


@pytest.mark.parametrize("text", ["rppm.alpha", "=3", 'objects["a=b"]', 'objects["a=3'])
def test_what_is_no_assignment_is_refused(text):
    with pytest.raises(SettingsError, match="path=value"):
        split_assignment(text)


@pytest.mark.parametrize(
    ("path", "value", "read"),
    [
        ("render.film_transparent", "true", lambda: bpy.context.scene.render.film_transparent is True),
        ("render.resolution_x", "77", lambda: bpy.context.scene.render.resolution_x == 77),
        ("view_settings.view_transform", "Raw", lambda: bpy.context.scene.view_settings.view_transform == "Raw"),
        (r'objects["A \"light\" = b"].data.energy', "50", lambda: bpy.data.lights["Light"].energy == 50.0),
        ('objects["Cube"].location', "1,2, -3", lambda: bpy.data.objects["Cube"].location[:] == (1, 2, -3)),
        ('objects["Cube"].location[2]', "-4.5", lambda: bpy.data.objects["Cube"].location[2] == -4.5),
        ('cameras["Camera"].type', "ORTHO", lambda: bpy.data.cameras["Camera"].type == "ORTHO"),
        ("camera", "None", lambda: bpy.context.scene.camera is None),
        ("camera", 'objects["Cube"]', lambda: bpy.context.scene.camera.name == "Cube"),
        ("render.filepath", '"//a b"', lambda: bpy.context.scene.render.filepath == "//a b"),
        ('["mine"]', "2.5", lambda: bpy.context.scene["mine"] == 2.5),
        (f'{PRINCIPLED}["Roughness"].default_value', "0.25", lambda: principled(2) == 0.25),
        (f"{PRINCIPLED}[0].default_value", "(1, 0.5, 0, 1)", lambda: principled(0)[1] == 0.5),
    ],
)
def test_values_of_every_kind_are_set(roots, path, value, read):
    assert not read()
    set_data_path(roots, path, value)
    assert read()


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("render.no_such", "1", "nothing of that name"),
        ("no_such.render", "1", "nothing of that name"),
        ('objects["Nobody"].location', "1,2,3", "nothing of that name"),
        ("render.film_transparent", "maybe", "neither true nor false"),
        ("render.resolution_x", "1.5", "no whole number"),
        ("render.resolution_x", "0", "not within 4 to 65536"),
        ("render.pixel_aspect_x", "nan", "not within"),
        ('objects["Cube"].location', "1,2", "takes 3 values"),
        ('objects["Cube"].location[3]', "1", "has 3 elements"),
        ('objects["Cube"].location', "a,b,c", "no number"),
        ('cameras["Camera"].type', "FISH", "FISH"),
        ("objects", "1", "cannot be changed"),
        ("camera", "Camera", "names nothing in the file"),
        ("camera", "render", "."),
        ('["other"]', "1", "no custom property"),
        ('["mine"]', "x", "no float"),
        ("render.__class__", "x", "nothing of that name"),
        ("render.bl_rna.name", "x", "nothing of that name"),
        ("__import__('os').system('true')", "x", "no data path"),
        ("", "x", "no data path"),
    ],
)
def test_what_does_not_resolve_or_fit_is_one_line(roots, path, value, message):
    with pytest.raises(SettingsError, match=message) as caught:
        set_data_path(roots, path, value)
    assert "\n" not in str(caught.value)
    assert not math.isnan(roots[0].render.pixel_aspect_x)
