# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what a frame costs in which one object of a scene has moved, with shared meshes and with expanded ones."""

import dataclasses
import statistics
import time
from pathlib import Path

import bpy
import numpy as np

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.materials.traits.emitted import Emits, emits
from rppm_addon.scene import Instancing, Scene
from rppm_addon.scene.storage.storage import load_scene

FRAMES = 24
_SIZE = 160, 90
_STEP = 0.01
"""Meters from frame to frame."""


def scene_of(path: Path) -> Scene:
    """The scene of a .blend file, or of a saved scene (.npz)."""
    if path.suffix == ".npz":
        return load_scene(path).expanded()
    rppm_addon.register()
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
        return export_scene(bpy.context.evaluated_depsgraph_get()).expanded()
    finally:
        rppm_addon.unregister()


def moving_member(scene: Scene) -> int:
    """Number of the instance with the most triangles that emits no light, has no medium inside, and is not the largest
    thing there: a floor would not move."""
    may_move = {
        number
        for number, material in enumerate(scene.materials)
        if material.interior is None and emits(material.graph) is Emits.NOTHING
    }
    sizes = []
    for number, instance in enumerate(scene.instances):
        mesh = scene.meshes[instance.mesh]
        if mesh.volume is None and may_move.issuperset(instance.materials) and mesh.triangle_count:
            extent = np.ptp(mesh.positions, axis=0) * np.linalg.norm(instance.matrix[:3, :3], axis=0)
            sizes.append((float(extent.max()), mesh.triangle_count, number))
    largest = max(sizes)
    return max(sizes, key=lambda entry: (entry is not largest, entry[1]))[2]


def measure(scene: Scene, instancing: Instancing, frames: int = FRAMES) -> list[float]:
    """Processor seconds of the update of each frame; the first frame's object has not moved before."""
    settings = dataclasses.replace(scene.settings, instancing=instancing, passes=())
    camera = camera_at_resolution(dataclasses.replace(scene.camera, crop=None), *_SIZE)
    scene = dataclasses.replace(scene, settings=settings, camera=camera)
    member = moving_member(scene)
    context = Context.create()
    library = ProgramLibrary(context)
    mapper = ProgressivePhotonMapper(context, library)
    mapper.build(scene)
    mapper.iterate()
    seconds = []
    for _ in range(frames):
        moved = scene.instances[member]
        matrix = np.array(moved.matrix)
        matrix[0, 3] += _STEP
        instances = list(scene.instances)
        instances[member] = dataclasses.replace(moved, matrix=matrix)
        scene = dataclasses.replace(scene, instances=instances)
        began = time.process_time()
        mapper.update(scene)
        context.finish()
        seconds.append(time.process_time() - began)
        mapper.iterate()
    mapper.release()
    library.release()
    context.release()
    return seconds


def row(path: Path, frames: int = FRAMES) -> str:
    """A scene's row of the table: seconds a frame, the median and the first, before and now."""
    scene = scene_of(path)
    before, now = measure(scene, Instancing.EXPANDED, frames), measure(scene, Instancing.AUTOMATIC, frames)
    medians = [statistics.median(seconds) for seconds in (before, now)]
    means = [statistics.mean(seconds) for seconds in (before, now)]
    cells = [
        path.stem,
        f"{scene.triangle_count:,}",
        *(f"{value:.3f}" for value in medians),
        f"{medians[1] / medians[0]:.2f}",
        f"{now[0]:.2f}",
        *(f"{value:.3f}" for value in means),
        f"{means[1] / means[0]:.2f}",
    ]
    return "| " + " | ".join(cells) + " |"


HEADER = (
    "| scene | triangles | expanded, s | shared, s | ratio | first move, s | mean of all: expanded | shared | ratio |\n"
    "|---|--:|--:|--:|--:|--:|--:|--:|--:|"
)
