# SPDX-License-Identifier: GPL-3.0-or-later
"""Do what a user does with the zip, in a Blender of its own: install it, then start again and render with it.

Run as ``python install_extension.py install ZIP``, then ``... render PICTURE``, with BLENDER_USER_RESOURCES set to
the same folder, empty at first; prints JSON.
"""

import json
import sys
from pathlib import Path

import bpy

MODULE = "bl_ext.user_default.rppm"


def render_default_scene(picture: Path) -> None:
    """Blender's own first scene, 16x16 pixels, rendered by RPPM to an EXR."""
    scene = bpy.context.scene
    scene.render.engine = "RPPM"
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.rppm.samples, scene.rppm.photons, scene.rppm.cubemap_resolution = 1, 512, 16
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)


def install(archive: str) -> dict:
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    report = {"enabled": MODULE in bpy.context.preferences.addons}
    bpy.ops.preferences.addon_disable(module=MODULE)  # an engine still registered at exit crashes or hangs Blender
    return report


def render(picture: str) -> dict:
    bpy.ops.preferences.addon_enable(module=MODULE)
    render_default_scene(Path(picture))
    import moderngl
    import numpy

    report = {"moderngl": moderngl.__file__, "numpy": numpy.__file__}
    report["outside"] = [name for name in sys.modules if name.split(".")[0] == "rppm_addon"]
    bpy.ops.preferences.addon_disable(module=MODULE)
    report["left"] = [name for name in dir(bpy.types) if name.startswith("RPPM_")]
    return report


if __name__ == "__main__":
    print(json.dumps({"install": install, "render": render}[sys.argv[1]](sys.argv[2])))
