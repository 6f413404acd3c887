# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that go through the pipe: whole, shared as they were, and cheap when little changes."""

import dataclasses
import gc
import json
import os
import sys
import weakref

import numpy as np
import pytest
from support.floor import floor_scene
from support.full_scene import assert_same, full_scene

from rppm_addon.scene import Image, Instance, Mesh, Particle, RayVisibility
from rppm_addon.session.transport.arrays import pack, unpack
from rppm_addon.session.transport.protocol import ProtocolError
from rppm_addon.session.transport.shared_memory import SharedBlock
from rppm_addon.session.transport.transfer import SceneReceiver, SceneSender


class Wire:
    """A sender and a receiver, with what goes between them as it would go."""

    def __init__(self):
        self.sender, self.receiver = SceneSender(), SceneReceiver()
        self.bytes = 0

    def send(self, scene, session=1):
        parts, whole = self.sender.send(session, scene)
        self.bytes = 0
        for part in parts:
            self.receiver.learn(*self.over(part))
        return self.receiver.receive(*self.over(whole))

    def over(self, part):
        """A part's document and arrays at the other end."""
        description, block = pack(part.arrays)
        text = json.dumps([part.document, description])
        self.bytes += len(text) + sum(array.nbytes for array in part.arrays)
        document, description = json.loads(text)
        arrays = unpack(description)
        if block is not None:
            block.close()
        return document, arrays

    def close(self, session):
        self.receiver.forget(self.sender.close(session))


def references(*objects):
    """Functions that return objects as long as somebody else keeps them."""
    return [weakref.ref(kept) for kept in objects]


def are_kept(watched):
    gc.collect()
    return [reference() is not None for reference in watched]


def large_scene():
    """The floor with an image that needs shared memory."""
    pixels = np.random.default_rng(0).random((128, 64, 4), np.float32)
    return dataclasses.replace(floor_scene(), images=[Image("Large", pixels)])


@pytest.mark.parametrize("make", [full_scene, floor_scene, large_scene])
def test_a_scene_arrives_whole(make):
    assert_same(make(), Wire().send(make()))


def test_what_did_not_change_is_the_same_object_again():
    wire, scene = Wire(), full_scene()
    first = wire.send(scene)
    whole = wire.bytes
    moved = dataclasses.replace(scene.instances[0], matrix=np.diag([2.0, 2.0, 2.0, 1.0]))
    changed = dataclasses.replace(scene, instances=[moved, scene.instances[1]], exposure=3.0, warnings=["new"])
    second = wire.send(changed)
    assert wire.bytes < 0.4 * whole
    assert_same(changed, second)
    for name in ("camera", "world", "settings"):
        assert getattr(second, name) is getattr(first, name)
    for name in ("meshes", "materials", "lights", "images"):
        for before, after in zip(getattr(first, name), getattr(second, name), strict=True):
            assert before is after
    assert second.instances[1] is first.instances[1] and second.instances[0] is not first.instances[0]


def test_members_in_another_order():
    wire, scene = Wire(), full_scene()
    first = wire.send(scene)
    second = wire.send(dataclasses.replace(scene, meshes=scene.meshes[::-1], instances=scene.instances * 3))
    assert second.meshes[0] is first.meshes[1] and second.meshes[1] is first.meshes[0]
    assert len(second.instances) == 6 and second.instances[4] is first.instances[0]


def test_what_no_session_uses_is_forgotten_on_both_sides():
    wire, scene = Wire(), full_scene()
    first = wire.send(scene, session=1)
    assert wire.send(scene, session=2).meshes[0] is first.meshes[0]
    images = references(scene.images[0], first.images[0])
    others = references(scene.meshes[0], first.meshes[0], first.instances[0].matrix, first.camera)
    scene = dataclasses.replace(scene, images=[])
    first = None
    wire.send(scene, session=1)
    assert all(are_kept(images))  # session 2 has it still
    wire.close(2)
    assert not any(are_kept(images)) and all(are_kept(others))
    wire.close(1)
    scene = None
    assert not any(are_kept(others))
    assert_same(full_scene(), wire.send(full_scene()))


def test_ids_that_python_gives_again():
    """A member that was freed may have its id taken by the next one."""
    wire = Wire()
    for size in range(1, 40):
        scene = dataclasses.replace(floor_scene(), images=[Image(str(size), np.full((size, 1, 4), size, np.float32))])
        assert_same(scene, wire.send(scene))


def test_a_scene_that_cannot_be_sent_leaves_nothing_half_known():
    wire, scene = Wire(), full_scene()
    large = Image("Large", np.zeros((512, 512, 4), np.float32))
    with pytest.raises(TypeError, match="object"):
        wire.sender.send(1, dataclasses.replace(scene, images=[large, object()]))
    watched = references(large, large.pixels)
    large = None
    assert not any(are_kept(watched))
    assert_same(scene, wire.send(scene))


def test_instances_that_stay_are_not_described_again():
    """One of 5000 is new: beside the order of all, which the whole has, a single part describes that one."""
    scene = floor_scene()
    scene.instances = [Instance(0, np.eye(4), [0], f"Stone {index}") for index in range(5000)]
    wire = Wire()
    wire.send(scene)
    everything = wire.bytes
    nudged = dataclasses.replace(scene, instances=[dataclasses.replace(scene.instances[0]), *scene.instances[1:]])
    parts, whole = wire.sender.send(1, nudged)
    assert len(parts) == 1 and list(parts[0].document) == ["instances"] and len(parts[0].document["instances"]) == 1
    described = len(json.dumps(parts[0].document)) + sum(array.nbytes for array in parts[0].arrays)
    assert described < everything / 1000
    assert len(whole.document["members"]["instances"]) == len(scene.instances)


def test_many_new_members_come_in_several_messages():
    scene = floor_scene()
    scene.instances = [Instance(0, np.full((4, 4), index), [0], f"Stone {index}") for index in range(10000)]
    scene.lights = [dataclasses.replace(scene.lights[0], name=f"Light {index}") for index in range(1000)]
    parts, _ = SceneSender().send(1, scene)
    assert len(parts) > 6
    assert max(len(json.dumps(part.document)) for part in parts) < 200_000
    assert_same(scene, Wire().send(scene))


def test_instances_of_every_kind():
    """Instances that go together need not be alike."""
    particle = Particle(3.0, 0.5, -1.5, 10.0, 0.1, (1.0, -0.0, 2.0), (0.0, 0.0, 1e-300), (np.inf, 0.0, 0.0))
    scene = floor_scene()
    scene.instances = [
        Instance(0, np.eye(4)),
        Instance(0, np.full((4, 4), np.nan), [0, 0, 1], "Twin", 7, (0.0, 1.0, 0.5, 0.25), 0.75, particle),
        Instance(0, np.eye(4), [0], "Twin", 1 << 20, (-0.0, 1.0, 0.5, 0.25), 1.0, None, RayVisibility(6), True, True),
        Instance(0, -np.eye(4), [], "", -1, attributes={"OBJECT:a": (1.0,), "INSTANCER:b": (0.5, -0.0, 3.0)}),
        Instance(0, np.eye(4), attributes={"OBJECT:a": (1.0,)}, particle=Particle()),
    ]
    received = Wire().send(scene).instances
    assert repr(received) == repr(scene.instances)
    for before, after in zip(scene.instances, received, strict=True):
        assert before.matrix.tobytes() == after.matrix.tobytes() and type(after.visibility) is RayVisibility
    with pytest.raises(TypeError, match="Light is no Instance"):
        SceneSender().send(1, dataclasses.replace(scene, instances=[*scene.instances, scene.lights[0]]))


def test_a_mesh_that_bends_sends_its_positions_only():
    wire, scene = Wire(), floor_scene()
    count = 1 << 18
    mesh = Mesh(
        "Sheet",
        np.zeros((count, 3), np.float32),
        np.arange(3 * count, dtype=np.int32) // 3,
        np.ones((3 * count, 3), np.float32),
        np.arange(3 * count, dtype=np.int32).reshape(-1, 3),
        np.zeros(count, np.int32),
    )
    scene.meshes = [mesh, dataclasses.replace(mesh, name="Other")]
    first = wire.send(scene)
    assert_same(scene, first)
    assert first.meshes[0].positions is first.meshes[1].positions
    for height in range(1, 4):
        moved = mesh.positions + np.float32([0.0, 0.0, height])
        scene = dataclasses.replace(scene, meshes=[dataclasses.replace(mesh, positions=moved), scene.meshes[1]])
        received = wire.send(scene)
        assert moved.nbytes < wire.bytes < 1.1 * moved.nbytes
        assert_same(scene, received)
        assert received.meshes[0].corner_normals is first.meshes[0].corner_normals
        assert received.meshes[1] is first.meshes[1]
    watched = references(mesh.positions, mesh.corner_normals, first.meshes[0].positions, received.meshes[0].positions)
    wire.send(dataclasses.replace(scene, meshes=[], instances=[]))
    mesh = scene = first = received = moved = None
    assert not any(are_kept(watched))


def test_arrays_of_every_kind():
    rng = np.random.default_rng(1)
    arrays = [
        rng.random((3, 5)), rng.random((4, 4), np.float32)[:, ::2], np.float32(2.0).reshape(()), np.zeros((0, 3)),
        rng.integers(0, 255, (7, 2, 4), np.uint8), np.arange(9, dtype=np.int32), np.array([True, False]),
        rng.random((300, 300)).T,
    ]  # fmt: skip
    for some in (arrays, arrays[:-1], []):
        description, block = pack(some)
        assert (block is None) == ("block" not in description) == (some is not arrays)
        received = unpack(json.loads(json.dumps(description)))
        for before, after in zip(some, received, strict=True):
            assert before.dtype == after.dtype and before.shape == after.shape
            np.testing.assert_array_equal(before, after)
            assert after.flags.writeable and after.flags.c_contiguous
        if block is not None:
            block.close()
            with pytest.raises(ProtocolError):
                unpack(description)


_LAYOUTS = [
    ["<f4", [1], -8], ["<f4", [1], -(1 << 44)], ["<f4", [1], 1 << 80], ["<f4", [1, -1], 0], ["<f4", [-1, -4], 0],
    ["<f4", [1, 1 << 20], 0], ["<f4", [1, 4], 1 << 30], ["<f4", [1 << 33, 1 << 33], 0], ["<f4", [1 << 40, 0], 0],
    ["<f4", [], 0], ["<f4", [1] * 9, 0], ["<f4", [1, 1.0], 0], ["<f4", [1, True], 0], ["<f4", [1], 0.0],
    ["<f4", 1, 0], ["O", [1, 1], 0], ["V0", [1 << 40], 0], ["<U0", [1 << 40], 0], ["f4,O", [1], 0], ["(9,9)f4", [1], 0],
    ["<m8", [1], 0], [5, [1], 0], ["<f4", [1]], ["<f4", [1], 0, 0], {}, None, "abc",
]  # fmt: skip
"""Invalid descriptions of runs of arrays, as a broken or malicious process may send them."""


@pytest.mark.parametrize("values", [1 << 6, 1 << 15], ids=["in the message", "in shared memory"])
@pytest.mark.parametrize("entry", _LAYOUTS, ids=repr)
def test_arrays_that_are_not_there(entry, values):
    description, block = pack([np.zeros(values)])
    with pytest.raises(ProtocolError):
        unpack(json.loads(json.dumps(description | {"layout": [entry]})))
    if block is not None:
        block.close()


def test_bytes_stand_for_one_array():
    """Found by fuzzing: a layout that names the same bytes again and again would fill the memory."""
    description, _ = pack([np.zeros(64)])
    (entry,) = description["layout"]
    for layout in ([entry, entry], [entry, [entry[0], [1], 8]]):
        with pytest.raises(ProtocolError, match="amid another"):
            unpack(description | {"layout": layout})


@pytest.mark.parametrize(
    "change",
    [
        {"block": "/etc/passwd"}, {"block": "/proc/1/fd/0:1"}, {"block": 5}, {"block": None}, {"size": 1 << 40},
        {"size": None}, {"size": -1}, {"size": 0}, {"size": 1e5}, {"size": True}, {"layout": 5}, {"layout": [[]]},
    ],
)  # fmt: skip
def test_arrays_that_nobody_packed(change):
    description, block = pack([np.zeros(1 << 15)])
    with pytest.raises(ProtocolError):
        unpack(description | change)
    block.close()


@pytest.mark.parametrize("text", ["", "AAAA", "?" * 8, 5, "\u0661"])
def test_bytes_that_nobody_wrote(text):
    with pytest.raises(ProtocolError):
        unpack({"layout": [["<f4", [1], 0]], "size": 64, "bytes": text})


@pytest.mark.skipif(sys.platform == "win32", reason="Windows' blocks keep their size")
def test_memory_that_could_be_cut_off_is_not_read():
    """To read what the other process has cut off would end this one by a signal."""
    block = SharedBlock.create(1 << 16)
    with pytest.raises(PermissionError):
        os.truncate(block.name.partition(":")[0], 0)
    block.close()
    file = os.memfd_create("rppm")
    os.ftruncate(file, 1 << 16)
    name = f"/proc/{os.getpid()}/fd/{file}:{os.fstat(file).st_ino}"
    with pytest.raises(ValueError, match="smaller"):
        SharedBlock.open(name, 1 << 16)
    os.close(file)


def test_shared_memory_that_does_not_suffice():
    with pytest.raises(OSError):
        SharedBlock.create(1 << 50)


def test_blocks_that_are_withdrawn():
    block = SharedBlock.create(100)
    other = SharedBlock.open(block.name, 100)
    block.memory[:3] = b"abc"
    block.withdraw()
    block.withdraw()
    assert other.memory[:3] == b"abc"
    again = SharedBlock.create(100)  # by the same number
    for size in (100, 10):
        with pytest.raises(FileNotFoundError):
            SharedBlock.open(block.name, size)
    for each in (block, other, again):
        each.close()
