# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender scenes in which things move."""

import bpy

from rppm_addon.scene import Scene
from rppm_addon.session.render.observers import RenderObserver, observing

FRAME = 10


class SceneTaker(RenderObserver):
    """Takes the scene that the engine exports and ends the render there."""

    def __init__(self) -> None:
        self.scene: Scene | None = None
        self.error = ""

    def on_scene(self, scene: Scene) -> bool:
        self.scene = scene
        return False

    def on_error(self, text: str) -> None:
        self.error = text


def blur(shutter: float = 1.0, position: str = "CENTER") -> None:
    """Open the current scene's shutter at FRAME."""
    scene = bpy.context.scene
    scene.frame_set(FRAME)
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter, scene.render.motion_blur_position = shutter, position


def animate(owner: bpy.types.bpy_struct, name: str, *values: object) -> None:
    """Values of a property at the frames around FRAME, the middle one at FRAME; straight from one to the next."""
    for frame, value in enumerate(values, FRAME - len(values) // 2):
        setattr(owner, name, value)
        owner.keyframe_insert(name, frame=frame)
    action = owner.id_data.animation_data.action
    curves = [curve for bag in action.layers[0].strips[0].channelbags for curve in bag.fcurves]
    for curve in curves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def taken_scene() -> Scene:
    """The current Blender scene as a final render with RPPM exports it."""
    scene, taker = bpy.context.scene, SceneTaker()
    engine, scene.render.engine = scene.render.engine, "RPPM"
    try:
        with observing(taker):
            bpy.ops.render.render()
    finally:
        scene.render.engine = engine
    assert taker.scene is not None, taker.error
    return taker.scene
