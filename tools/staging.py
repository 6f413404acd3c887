# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a .blend file ready to be rendered beside Cycles: ``python tools/staging.py SOURCE TARGET [PATH=VALUE ...]``.

TARGET is written where something is missing or set. A file without a camera gets one that sees all surfaces, and a sun
where it has no lamp. Of a library of materials, a file whose surfaces use the fewest of what it has, BALLS materials
are drawn, always the same, and put on balls above a floor (tests/parity/material_previews.py).
"""

import random
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import bpy  # noqa: E402 (the checkout, installed or not)
from mathutils import Vector  # noqa: E402

from rppm_addon.commands.data_paths import set_data_path, split_assignment  # noqa: E402
from tests.parity.material_previews import Preview, build  # noqa: E402

BALLS = 10
_WITH_SURFACES = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
_FROM = Vector((0.45, -1.0, 0.55))
"""Towards a camera that is added, from what it looks at."""
_AIR = 1.15
"""How much farther away it is than it must."""


def is_library() -> bool:
    """Whether the open file is there for its materials."""
    materials = [material for material in bpy.data.materials if not material.is_grease_pencil]
    used = {slot.material for part in bpy.context.scene.objects for slot in part.material_slots}
    return bpy.context.scene.camera is None and len(materials) > 4 * max(len(used), 1)


def show_materials(source: Path) -> None:
    """Open a scene of BALLS of the file's materials."""
    names = sorted(material.name for material in bpy.data.materials if not material.is_grease_pencil)
    always_the_same = random.Random(1)  # nosec B311
    chosen = always_the_same.sample(names, min(BALLS, len(names)))
    build([Preview(str(source), name) for name in chosen])


def add_camera(scene: bpy.types.Scene) -> None:
    """A camera that sees all surfaces, and a sun where nothing but the world shines."""
    corners = [
        value
        for part in scene.objects
        if part.type in _WITH_SURFACES
        for corner in part.bound_box
        for value in part.matrix_world @ Vector(corner)
    ]
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.rotation_euler = _FROM.to_track_quat("Z", "Y").to_euler()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    depsgraph.update()
    near, _ = camera.camera_fit_coords(depsgraph, corners)
    middle = sum((Vector(corners[at : at + 3]) for at in range(0, len(corners), 3)), Vector()) / (len(corners) / 3)
    camera.location = middle + (near - middle) * _AIR
    if not any(part.type == "LIGHT" for part in scene.objects):
        sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy = 3.0
        sun.rotation_euler = (0.6, 0.3, 0.0)
        scene.collection.objects.link(sun)


def main() -> None:
    """Stage a file."""
    source, target, values = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3:]
    bpy.ops.wm.open_mainfile(filepath=str(source), load_ui=False, use_scripts=False)
    is_complete = bpy.context.scene.camera is not None
    if is_library():
        show_materials(source)
    elif not is_complete:
        add_camera(bpy.context.scene)
    for path, value in map(split_assignment, values):
        set_data_path((bpy.context.scene, bpy.data), path, value)
    if values or not is_complete:
        bpy.ops.wm.save_as_mainfile(filepath=str(target), check_existing=False)


if __name__ == "__main__":
    main()
