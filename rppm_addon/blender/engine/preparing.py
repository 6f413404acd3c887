# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that are compiled while a user still looks at the solid view of a file, once RPPM is to render it."""

import logging
import time

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ...scene import Camera, Material, Scene
from ...session.client.client import ProcessState
from ..export import export_settings
from ..export.common.report import Report
from ..export.context import ExportContext
from ..export.geometry.strands.round_meshes import ROUND_TYPES
from ..export.images.color_spaces import working_space
from ..export.images.images import MISSING, ImageTable
from ..export.shading.nodes.materials import export_material
from ..render_client import renderer_process
from .render_engine import RppmRenderEngine

logger = logging.getLogger(__name__)

IDLE_SECONDS = 2.0
"""After a file is opened, or the engine is chosen: whoever renders at once needs nobody to prepare."""
_SLICE_SECONDS = 0.02
_RESOLUTION, _WINDOW = 64, (-1.0, 1.0, -1.0, 1.0)
"""The programs are those of any picture."""


class _NoImages(ImageTable):
    """Images cost their reading, and no program depends on them."""

    def computed(self, *_: object) -> int:
        """None of skies."""
        return MISSING

    def _index(self, *_: object) -> int:
        return MISSING


class _NoReport(Report):
    """Report without warnings: those about the materials are given when they are rendered."""

    def warn(self, text: str) -> None:
        """Say nothing."""


class _Preparing:
    """Exports a file's materials bit by bit, and has their programs compiled."""

    def __init__(self) -> None:
        self._context = ExportContext(_NoReport(), viewport=True, images=_NoImages())
        self._names = [material.name for material in bpy.data.materials if material.users > material.use_fake_user]
        self._round = _materials_of_round_shapes()
        self._materials: list[Material] = []

    def advance(self) -> bool:
        """Do a little; returns whether there is more to be done."""
        end = time.monotonic() + _SLICE_SECONDS
        while self._names:
            material = bpy.data.materials.get(self._names.pop())
            if material is not None:
                exported = export_material(material, self._context)
                exported.on_round_shapes = material.name in self._round
                self._materials.append(exported)
            if time.monotonic() >= end:
                break
        if self._names:
            return True
        settings = export_settings(bpy.context.scene, bpy.context.view_layer, viewport=True)
        camera = Camera(np.eye(4), _WINDOW, _RESOLUTION, _RESOLUTION)
        space = working_space().name
        scene = Scene(camera, materials=self._materials, settings=settings, working_space=space)
        renderer_process.renderer_process().prepare(scene)
        return False


def _materials_of_round_shapes() -> set[str]:
    """Names of the materials of objects that are strands or points, or have hair; those that only nodes of geometry
    make are not known before they are evaluated."""
    hair = {part.name for part in bpy.data.particles if part.type == "HAIR" and part.render_type == "PATH"}
    return {
        slot.material.name
        for thing in bpy.data.objects
        if thing.type in ROUND_TYPES
        or (hair and any(system.settings.name in hair for system in thing.particle_systems))
        for slot in thing.material_slots
        if slot.material is not None
    }


_preparing: _Preparing | None = None
_SUBSCRIBER = object()
"""Owns the subscription to the engine."""


def _is_wanted() -> bool:
    """Whether RPPM is to render the file, and nobody renders yet."""
    scene = bpy.context.scene
    active = scene is not None and scene.render.engine == RppmRenderEngine.bl_idname
    if not (active and renderer_process.is_used()):
        return False
    return renderer_process.renderer_process().state is ProcessState.STOPPED


def _go_on() -> float | None:
    global _preparing
    try:
        if _is_wanted():
            _preparing = _preparing or _Preparing()
            if _preparing.advance():
                return _SLICE_SECONDS
    except Exception:  # whoever renders says so
        logger.info("nothing is prepared", exc_info=True)
    _preparing = None
    return None


def _begin_soon() -> None:
    _stop()
    bpy.app.timers.register(_go_on, first_interval=IDLE_SECONDS)


@persistent
def _on_load(*_: object) -> None:
    _watch_engine()  # Blender drops subscriptions with the file before
    _begin_soon()


def _watch_engine() -> None:
    """Prepare when a user chooses another engine, as it may be RPPM."""
    bpy.msgbus.clear_by_owner(_SUBSCRIBER)
    bpy.msgbus.subscribe_rna(key=(bpy.types.RenderSettings, "engine"), owner=_SUBSCRIBER, args=(), notify=_begin_soon)


def _stop() -> None:
    global _preparing
    _preparing = None
    if bpy.app.timers.is_registered(_go_on):
        bpy.app.timers.unregister(_go_on)


def register() -> None:
    """Prepare for files that are opened, and when an engine is chosen, from now on."""
    bpy.app.handlers.load_post.append(_on_load)
    _watch_engine()


def unregister() -> None:
    """Prepare for none."""
    bpy.app.handlers.load_post.remove(_on_load)
    bpy.msgbus.clear_by_owner(_SUBSCRIBER)
    _stop()
