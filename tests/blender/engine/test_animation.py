# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames that follow each other: each is that of a fresh render, bit for bit, and only what changed is done anew."""

import dataclasses
import os

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, collect, set_world
from exr import read_channels, write_exr
from node_trees import add_node, new_material, surface
from recorder import Recorder, record

from rppm_addon.blender.engine import frame_reuse
from rppm_addon.integrator.device_scene.acceleration import Acceleration
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.integrator.surfaces.geometry import Geometry

LAST = 6


def keyed(owner, path, values):
    """Give a property a value in each frame from 1 on, without anything between."""
    target, _, name = path.rpartition(".")
    holder = owner.path_resolve(target) if target else owner
    for frame, value in enumerate(values, 1):
        if name.startswith('["'):
            holder[name[2:-2]] = value
        else:
            setattr(holder, name, value)
        holder.keyframe_insert(name, frame=frame)


def colored(name, color):
    return surface("ShaderNodeBsdfDiffuse", material=new_material(name), Color=(*color, 1.0))[0]


COLORS = {"Red": (0.8, 0.1, 0.1), "Blue": (0.1, 0.1, 0.8), "Changing": (0.1, 0.8, 0.1)}


@pytest.fixture
def moving(lit):
    """A floor, things that change in all the ways that Blender tells of, and some of which it tells nothing."""
    lit.render.resolution_x, lit.render.resolution_y = 16, 12
    lit.camera.data.type = "PERSP"
    lit.rppm.photons, lit.rppm.samples = 512, 3
    lit.frame_start, lit.frame_end = 1, LAST
    floor = bpy.data.objects["Quad"]
    floor.scale = (3.0, 3.0, 1.0)
    keyed(lit.camera, "location", [(0.1 * frame, 0.0, 5.0) for frame in range(LAST)])

    red, blue, changing = (colored(name, color) for name, color in COLORS.items())
    row = add_mesh(lit, "Row", location=(-1.0, 0.5, 0.5), scale=(0.3, 0.3, 1.0), material=red)
    array = row.modifiers.new("Array", "ARRAY")
    array.relative_offset_displace = (1.3, 0.0, 0.0)
    keyed(row, "modifiers[0].count", (1, 1, 3, 3, 2, 2))

    gone = add_mesh(lit, "Gone", location=(0.8, -0.8, 1.0), scale=(0.5, 0.5, 1.0), material=blue)
    keyed(gone, "hide_render", (False, False, False, True, True, False))

    add_mesh(lit, "Shown", location=(-0.8, -0.8, 0.5), scale=(0.5, 0.5, 1.0), material=changing)
    colors = [(0.1 * frame, 0.8, 0.1, 1.0) for frame in (1, 1, 2, 2, 2, 3)]
    keyed(changing, 'node_tree.nodes["Diffuse BSDF"].inputs[0].default_value', colors)

    asking = new_material("Asking")
    glow = add_node(asking.node_tree, "ShaderNodeAttribute", attribute_type="VIEW_LAYER", attribute_name="glow")
    surface("ShaderNodeEmission", material=asking, Strength=glow.outputs["Fac"])
    add_mesh(lit, "Glowing", location=(0.9, 0.9, 0.2), scale=(0.3, 0.3, 1.0), material=asking)
    keyed(lit, '["glow"]', (0.5, 0.5, 0.5, 0.5, 2.0, 2.0))

    light = add_light(lit, "POINT", "Light", energy=50.0)
    keyed(light.data, "energy", (50.0, 50.0, 50.0, 20.0, 20.0, 20.0))
    keyed(lit.world, 'node_tree.nodes["Background"].inputs[1].default_value', (1.0, 1.0, 1.0, 1.0, 1.0, 3.0))
    lit.world.node_tree.nodes["Background"].inputs[0].default_value = (0.05, 0.05, 0.1, 1.0)
    return lit


def pixels(path):
    """All numbers of a file."""
    return np.concatenate([channel.reshape(-1) for _, channel in sorted(read_channels(path)[0].items())])


def write_exr_files(scene, folder):
    write_exr(scene, folder / "####.exr", is_multilayer=False)


def animation(scene, folder, persistent):
    """Pictures by frame."""
    write_exr_files(scene, folder)
    scene.render.use_persistent_data = persistent
    bpy.ops.render.render(animation=True)
    scene.render.use_persistent_data = False
    return [pixels(folder / f"{frame:04d}.exr") for frame in range(scene.frame_start, scene.frame_end + 1)]


def still(scene, folder, frame):
    """The picture of one frame, of which nothing was known before."""
    frame_reuse.forget()
    write_exr_files(scene, folder)
    scene.frame_set(frame)
    scene.render.filepath = str(folder / "still.exr")
    bpy.ops.render.render(write_still=True)
    return pixels(folder / "still.exr")


@pytest.mark.parametrize("use_animated_seed", [False, True])
def test_each_frame_is_that_of_a_fresh_render(moving, tmp_path, use_animated_seed):
    moving.rppm.use_animated_seed = use_animated_seed
    fresh = [still(moving, tmp_path, frame) for frame in range(1, LAST + 1)]
    assert len({picture.tobytes() for picture in fresh}) == LAST
    assert_same(moving, tmp_path, fresh)


def assert_same(scene, folder, fresh):
    """Frames of an animation are those of fresh renders, whether or not Blender keeps what it has evaluated."""
    for persistent in (False, True):
        pictures = animation(scene, folder, persistent)
        for frame, (shown, expected) in enumerate(zip(pictures, fresh, strict=True), 1):
            assert shown.tobytes() == expected.tobytes(), (persistent, frame, np.abs(shown - expected).max())


@pytest.mark.parametrize("position", ["CENTER", "END"])
def test_each_blurred_frame_is_that_of_a_fresh_render(moving, tmp_path, position):
    """Frames before it, which it goes to for its keys, and those after it leave nothing behind."""
    moving.frame_end = 3
    sharp = still(moving, tmp_path, 2)
    render = moving.render
    render.use_motion_blur, render.motion_blur_shutter, render.motion_blur_position = True, 0.9, position
    fresh = [still(moving, tmp_path, frame) for frame in range(1, 4)]
    assert fresh[1].tobytes() != sharp.tobytes()
    assert_same(moving, tmp_path, fresh)
    render.use_persistent_data = True
    for frame in (1, 3):  # sharp, then blurred, which takes in what Blender tells
        moving.frame_set(frame)
        render.use_motion_blur = frame == 3
        bpy.ops.render.render()
    render.use_motion_blur = False
    moving.frame_set(2)
    render.filepath = str(tmp_path / "sharp.exr")
    bpy.ops.render.render(write_still=True)
    render.use_persistent_data = False
    assert pixels(tmp_path / "sharp.exr").tobytes() == sharp.tobytes()


@pytest.mark.parametrize("persistent", [False, True])
def test_only_what_changed_is_uploaded_and_built(moving, tmp_path, monkeypatch, persistent):
    """The camera moves in all frames, geometry changes in those where rows grow or objects come and go."""
    done = []

    def watch(kind, method, word):
        original = getattr(kind, method)
        monkeypatch.setattr(kind, method, lambda *a, **k: (done.append(word), original(*a, **k))[1])

    watch(Geometry, "build", "geometry")
    watch(Acceleration, "build", "structure")
    watch(ProgressivePhotonMapper, "update", "frame")
    frame_reuse.forget()
    animation(moving, tmp_path, persistent)
    frames = " ".join(done).split("frame")[1:]
    words = [sorted(set(frame.split())) for frame in frames]
    assert words == [["geometry", "structure"], [], *[["geometry", "structure"]] * 4]


def test_layers_take_turns(moving, tmp_path):
    """With persistent data Blender tells of a layer's depsgraph as if it had been there in the frame before."""
    scene = moving
    second = scene.view_layers.new("Second")
    hidden = collect(scene, bpy.data.objects["Row"], name="Hidden")
    scene.collection.children.link(hidden)
    second.layer_collection.children["Hidden"].exclude = True
    scene.frame_end = 3
    for persistent in (False, True):
        scene.render.use_persistent_data = persistent
        write_exr_files(scene, tmp_path)
        scenes = record(animation=True).scenes
        shown = ["Row" in {instance.object_name for instance in exported.instances} for exported in scenes]
        assert shown == [True, False] * 3
    scene.render.use_persistent_data = False


@pytest.mark.parametrize("persistent", [False, True])
def test_a_broken_frame_ends_nothing_but_itself(moving, tmp_path, persistent):
    expected = [still(moving, tmp_path, frame) for frame in (1, 3)]
    moving.frame_end = 3
    keyed(moving, "rppm.radius_minimum", (0.0, 2.0, 0.0))
    keyed(moving, "rppm.radius_maximum", (0.0, 1.0, 0.0))
    recorder = Recorder()

    write_exr_files(moving, tmp_path)
    moving.render.use_persistent_data = persistent
    (tmp_path / "0002.exr").write_text("of a render before")

    def date(*_):
        """As if the clock had been set back, or were another machine's."""
        for path in tmp_path.glob("*.exr"):
            os.utime(path, (0.0, 0.0))

    bpy.app.handlers.render_write.insert(0, date)
    try:
        record(recorder, animation=True)
    finally:
        bpy.app.handlers.render_write.remove(date)
    assert len(recorder.errors) == 1 and "radius_maximum" in recorder.errors[0]
    for frame, picture in zip((1, 3), expected):
        assert pixels(tmp_path / f"{frame:04d}.exr").tobytes() == picture.tobytes()
    assert not (tmp_path / "0002.exr").exists()


def test_broken_layers_do_not_end_blender(moving, tmp_path):
    """Blender crashes when it is to save several layers of which it was given none."""
    moving.view_layers.new("Second")
    moving.frame_end = 2
    keyed(moving, "rppm.radius_minimum", (2.0, 0.0))
    keyed(moving, "rppm.radius_maximum", (1.0, 0.0))
    write_exr_files(moving, tmp_path)
    bpy.ops.render.render(animation=True)
    assert not (tmp_path / "0001.exr").exists()
    assert pixels(tmp_path / "0002.exr").any()
    moving.frame_set(1)
    with pytest.raises(RuntimeError, match="radius_maximum"):  # a still ends there
        bpy.ops.render.render()


def test_what_is_kept_is_dropped_with_the_file(moving):
    recorder = record()
    (kept,) = recorder.scenes
    again = dataclasses.replace(kept)
    assert frame_reuse.reuse_previous_frame(again) is kept
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert frame_reuse.reuse_previous_frame(again) is again
    frame_reuse.forget()


def test_a_scene_that_is_rendered_again_is_the_scene_before(lit):
    set_world(lit, (0.1, 0.1, 0.1))
    lit.render.use_stamp_date = False  # it is another each second
    seen = [record().scenes[0] for _ in range(2)]
    assert seen[0] is seen[1]
