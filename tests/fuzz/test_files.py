# SPDX-License-Identifier: GPL-3.0-or-later
"""Saved scenes and checkpoints that are damaged, forged, or of another mind."""

import io
import json
import zipfile

import hypothesis.strategies as st
import numpy as np
import OpenEXR
import pytest
from hypothesis import given
from support.checkpoints import signed, unsigned, write_part
from support.full_scene import full_scene

from fuzz.counting import fuzzed, may_refuse
from fuzz.values import NUMBERS, changed_documents, damaged_bytes
from rppm_addon.scene import load_scene, save_scene
from rppm_addon.scene.errors import CheckpointError, SceneError
from rppm_addon.session.checkpoints.checkpoint_file import read_checkpoint

DTYPES = ("<f4", "<f8", "<i4", "<i8", "|u1", "<u2", "|b1", "<f2")


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@pytest.fixture(scope="session")
def scene_file(folder):
    """A saved scene: its bytes, its document and its arrays."""
    return Good(folder / "good.npz")


class Good:
    """Shown in messages by its name alone."""

    def __init__(self, path):
        save_scene(full_scene(), path)
        with np.load(path) as stored:
            self.arrays = {name: stored[name] for name in stored.files}
        self.document = json.loads(self.arrays.pop("document").tobytes())
        self.bytes = path.read_bytes()


def converted(number, dtype):
    """A number as arrays of a type hold it."""
    with np.errstate(all="ignore"):
        return np.array([float(number)]).astype(dtype)[0]


def looks_right(scene):
    """Check the properties that renderers rely on, said again in other words than the gate's."""
    for mesh in scene.meshes:
        corners = mesh.corner_vertices[mesh.triangle_corners]  # raises for those that are beyond
        assert not mesh.triangle_corners.size or mesh.triangle_corners.min() >= 0
        assert not mesh.corner_vertices.size or mesh.corner_vertices.min() >= 0
        assert mesh.positions[corners].shape == (*mesh.triangle_corners.shape, 3)
        assert len(mesh.corner_normals) == len(mesh.corner_vertices)
        assert len(mesh.triangle_slots) == len(mesh.triangle_corners)
    for instance in scene.instances:
        assert instance.mesh >= 0 and scene.meshes[instance.mesh] is not None
        assert all(-1 <= place < len(scene.materials) for place in instance.materials)
    for light in scene.lights:
        assert np.isfinite(np.float32([*light.strength, light.radius, light.spread, *light.size])).all()
    assert np.isfinite(np.float32([scene.exposure, *scene.camera.window, *scene.world.radiance])).all()
    assert np.linalg.inv(scene.camera.matrix.astype(np.float64)).shape == (4, 4)
    for shutter in filter(None, (scene.shutter, scene.neighbors)):
        for movement in (*shutter.instances, *shutter.lights):
            assert np.isfinite(np.float32(movement.matrices)).all()
        shutter.time_of(0.5)
    for material in scene.materials:
        assert all(-1 <= node.image < len(scene.images) for node in material.graph.nodes)


def try_scene(path, way):
    with may_refuse(way, SceneError):
        looks_right(load_scene(path))


@fuzzed
@given(data=st.data())
def test_damaged_scenes(scene_file, folder, data):
    path = folder / "damaged.npz"
    path.write_bytes(data.draw(damaged_bytes(scene_file.bytes)))
    try_scene(path, "damaged-scenes")


@fuzzed
@given(data=st.data())
def test_forged_scenes(scene_file, folder, data):
    """Archives that are whole, with another document, and arrays of other types, shapes and values."""
    document, arrays = scene_file.document, scene_file.arrays
    if data.draw(st.booleans()):
        document = data.draw(changed_documents(document))
    arrays = dict(arrays)
    for name in data.draw(st.lists(st.sampled_from(sorted(arrays)), max_size=3)):
        with np.errstate(all="ignore"):
            array = arrays[name].astype(data.draw(st.sampled_from([arrays[name].dtype.str, *DTYPES])))
        change = data.draw(st.sampled_from(["value", "value", "shape", "rows", "none"]))
        if change == "value" and array.size:
            place = data.draw(st.integers(0, array.size - 1))
            array.reshape(-1)[place] = converted(data.draw(NUMBERS), array.dtype)
        elif change == "shape":
            array = array.reshape(-1)[: data.draw(st.integers(0, array.size))]
        elif change == "rows":
            array = array[: data.draw(st.integers(0, 3))] if array.ndim else array
        arrays[name] = array
    path = folder / "forged.npz"
    with zipfile.ZipFile(path, "w") as archive, np.errstate(all="ignore"):
        text = np.frombuffer(json.dumps(document).encode(), np.uint8)
        for name, array in {"document": text, **arrays}.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(array))
            archive.writestr(f"{name}.npy", buffer.getvalue())
    try_scene(path, "forged-scenes")


@pytest.fixture(scope="session")
def checkpoint(folder):
    """A checkpoint's bytes without its digest."""
    return unsigned(write_part(folder / "good.exr", 0, 5).read_bytes())


def try_checkpoint(path, way):
    with may_refuse(way, CheckpointError):
        summary, pause = read_checkpoint(path)
        height, width = pause.state.radiance.shape[:2]
        assert 0 <= summary.sample_offset < summary.iteration
        assert summary.render.placement.x + width <= summary.render.placement.width
        assert all(array.shape[:2] == (height, width) for array in pause.state.passes.values())


@fuzzed
@given(data=st.data())
def test_damaged_checkpoints(checkpoint, folder, data):
    path = folder / "damaged.exr"
    path.write_bytes(data.draw(damaged_bytes(signed(checkpoint))))
    try_checkpoint(path, "damaged-checkpoints")


@fuzzed
@given(data=st.data())
def test_forged_checkpoints(folder, data):
    """Whole ones that say what no render says."""
    with OpenEXR.File(str(folder / "good.exr"), separate_channels=True) as file:
        parts = [(dict(file.header(part)), dict(file.channels(part))) for part in range(2)]
    document = data.draw(changed_documents(json.loads(parts[0][0]["rppm.checkpoint"])))
    parts[0][0]["rppm.checkpoint"] = json.dumps(document)
    for _, channels in parts:
        if data.draw(st.integers(0, 3)) == 0:
            del channels[data.draw(st.sampled_from(sorted(channels)))]
    path = folder / "forged.exr"
    made = [
        OpenEXR.Part(header, {name: channel.pixels for name, channel in channels.items()}, name)
        for (header, channels), name in zip(parts, ("film", "guide"), strict=True)
    ]
    OpenEXR.File(made).write(str(path))
    path.write_bytes(signed(path.read_bytes()))
    try_checkpoint(path, "forged-checkpoints")


@pytest.fixture(scope="session", autouse=True)
def _made(checkpoint):
    """The good checkpoint is there for all."""
