# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are no saved scenes: SceneError and nothing else, soon, and in little memory."""

import io
import json
import os
import random
import resource
import zipfile

import numpy as np
import pytest
from support.floor import floor_scene
from support.full_scene import assert_same, full_scene

from rppm_addon.scene import load_scene, save_scene
from rppm_addon.scene.errors import SceneError
from rppm_addon.scene.storage import storage


def array_bytes(array):
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, array, allow_pickle=True)
    return buffer.getvalue()


def head(text):
    """Return the header of an array's file, with this text as its description."""
    data = text.encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + len(data).to_bytes(2, "little") + data


def archive(path, compression=zipfile.ZIP_DEFLATED, **entries):
    with zipfile.ZipFile(path, "w", compression) as file:
        for name, data in entries.items():
            file.writestr(f"{name}.npy", data if isinstance(data, bytes) else array_bytes(data))
    return path


def document(value):
    text = value if isinstance(value, str) else json.dumps(value)
    return np.frombuffer(text.encode(), np.uint8)


def scene_document(path, **members):
    """The document of a good scene with other members."""
    save_scene(floor_scene(), path)
    with np.load(path) as stored:
        arrays = {name: stored[name] for name in stored.files}
    good = json.loads(arrays["document"].tobytes())
    good["scene"] |= members
    return archive(path, **(arrays | {"document": document(good)}))


DOCUMENTS = {
    "no JSON": "{",
    "no text": b"\xff\xfe".decode("latin-1"),
    "a list": [],
    "a number": 5,
    "nothing": None,
    "no format": {"scene": {}},
    "a format that is a list": {"format": [5], "scene": {}},
    "no scene": {"format": storage.FORMAT},
    "an empty scene": {"format": storage.FORMAT, "scene": {}},
    "a scene that is a list": {"format": storage.FORMAT, "scene": [1]},
    "deep lists": "[" * 100000 + "]" * 100000,
    "a long number": "9" * 10000,
}
HEADS = {
    "more than memory": "{'descr': '<f4', 'fortran_order': False, 'shape': (1099511627776,)}",
    "less than nothing": "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
    "objects": "{'descr': '|O', 'fortran_order': False, 'shape': (1,)}",
    "texts": "{'descr': '<U0', 'fortran_order': False, 'shape': (1099511627776,)}",
    "no type": "{'descr': '<z9', 'fortran_order': False, 'shape': (1,)}",
    "code": "__import__('os').system('false')",
    "deep brackets": "(" * 5000,
    "an open text": "'",
    "nothing": "",
}


@pytest.mark.parametrize("value", DOCUMENTS.values(), ids=DOCUMENTS)
def test_documents_that_are_no_scene(tmp_path, value):
    with pytest.raises(SceneError, match="export"):
        load_scene(archive(tmp_path / "a.npz", document=document(value)))


@pytest.mark.parametrize("text", HEADS.values(), ids=HEADS)
@pytest.mark.parametrize("name", ["document", "array0"])
def test_arrays_that_are_none(tmp_path, text, name):
    with pytest.raises(SceneError):
        load_scene(archive(tmp_path / "a.npz", **({"document": document({})} | {name: head(text)})))


@pytest.mark.parametrize(
    "members",
    [
        {"meshes": None}, {"meshes": 5}, {"meshes": [[]]}, {"meshes": [{"name": "a"}]}, {"camera": None},
        {"camera": {"matrix": {"array": "array0"}}}, {"lights": [{"kind": "LASER"}]}, {"settings": {"iterations": []}},
        {"exposure": {}}, {"instances": [{"visibility": "all"}]}, {"shutter": 5}, {"warnings": "w"}, {"more": 1},
        {"images": [{"name": "i", "pixels": {"array": "array99"}}]}, {"images": [{"name": "i", "pixels": {}}]},
        {"world": {"radiance": {"array": "document"}}}, {"asset_names": ["a"]}, {"stamps": {"a": None}},
    ],
    ids=repr,
)  # fmt: skip
def test_members_that_are_none(tmp_path, members):
    with pytest.raises(SceneError, match=r"a\.npz.*export it again"):
        load_scene(scene_document(tmp_path / "a.npz", **members))


def test_what_would_fill_the_memory_is_not_unpacked(tmp_path, monkeypatch):
    """A thousandth of the bytes on the disk; the limit is lowered, to make the test short."""
    monkeypatch.setattr(storage, "MIN_LIMIT", 1 << 22)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(SceneError, match="would take 64.0 MiB of memory for .* KiB on the disk"):
        load_scene(archive(tmp_path / "bomb.npz", document=np.zeros(1 << 26, np.uint8)))
    with pytest.raises(SceneError, match="would take 64.0 MiB"):  # in many entries
        load_scene(archive(tmp_path / "bomb.npz", **{f"array{i}": np.zeros(1 << 20, np.uint8) for i in range(64)}))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 3 << 16  # kilobytes, of making the files


def test_an_entry_that_hides_its_size(tmp_path):
    """Only as much is unpacked as the directory of the archive says."""
    path = archive(tmp_path / "a.npz", document=np.zeros(1 << 20, np.uint8))
    data = path.read_bytes()
    true = ((1 << 20) + 128).to_bytes(4, "little")
    assert data.count(true) == 2
    path.write_bytes(data.replace(true, (200).to_bytes(4, "little")))
    with pytest.raises(SceneError, match="CRC"):
        load_scene(path)


def test_pictures_of_one_color_are_let_in(tmp_path):
    """Data that can be packed a thousandfold is not only made to do harm."""
    scene = floor_scene()
    scene.images[:] = [type(full_scene().images[0])("Black", np.zeros((2048, 1024, 4), np.float32))]
    save_scene(scene, tmp_path / "black.npz")
    assert_same(load_scene(tmp_path / "black.npz").images, scene.images)


def test_damaged_files(tmp_path):
    """Bits that flip, and ends that are missing: a scene, which must be a sound one, or SceneError."""
    path = tmp_path / "scene.npz"
    save_scene(full_scene(), path)
    good, chance, refused = path.read_bytes(), random.Random(1), 0
    for case in range(150):
        data = bytearray(good)
        if case % 3 == 0:
            data = data[: chance.randrange(len(data))]
        else:
            for _ in range(chance.choice([1, 1, 8])):
                data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        path.write_bytes(data)
        try:
            load_scene(path)
        except SceneError as error:
            assert str(path) in str(error) and "\n" not in str(error)
            refused += 1
    assert refused > 100


@pytest.mark.parametrize("kind", ["nothing", "text", "numbers", "folder", "pipe", "absent"])
def test_other_files_are_refused_in_one_line(tmp_path, kind):
    path = tmp_path / "a.npz"
    if kind == "nothing":
        path.touch()
    elif kind == "text":
        path.write_bytes(b"not a scene")
    elif kind == "numbers":
        np.savez(path, x=np.zeros(3))
    elif kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)  # who opens it waits for somebody that writes
    with pytest.raises(SceneError, match="rppm export") as error:
        load_scene(path)
    assert "\n" not in str(error.value)


def test_too_few_file_handles_are_called_so(tmp_path):
    path = tmp_path / "scene.npz"
    save_scene(floor_scene(), path)
    limits = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, limits[1]))
    try:
        with pytest.raises(SceneError, match="ulimit"):
            load_scene(path)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, limits)
