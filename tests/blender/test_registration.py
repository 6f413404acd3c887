# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration: what register adds to Blender, what unregister leaves behind, and the extension's outside."""

import subprocess
import sys
from pathlib import Path

import bpy

import rppm_addon

ROOT = Path(__file__).resolve().parents[2]


def panels_of_blender():
    panels = [panel for panel in bpy.types.Panel.__subclasses__() if hasattr(panel, "COMPAT_ENGINES")]
    return [panel for panel in panels if "rppm_addon" not in panel.__module__]


def test_unregister_leaves_nothing(scene):
    rppm_addon.unregister()
    try:
        assert not any("RPPM" in panel.COMPAT_ENGINES for panel in panels_of_blender())
        assert not hasattr(bpy.types.Scene, "rppm") and not hasattr(bpy.types.Light, "rppm")
        assert not [name for name in dir(bpy.types) if name.lower().startswith("rppm")]
        assert not [name for name in dir(bpy.ops.rppm) if not name.startswith("_")]
        assert not bpy.utils.preset_paths("rppm")
        functions = [*bpy.types.VIEW3D_HT_header._dyn_ui_initialize(), *bpy.app.handlers.load_post]
        assert not [function for function in functions if function.__module__.startswith("rppm_addon")]
        engines = bpy.types.RenderSettings.bl_rna.properties["engine"].enum_items
        assert "RPPM" not in engines or scene.render.engine != "RPPM"
    finally:
        rppm_addon.register()
    assert bpy.context.scene.rppm.samples > 0


def test_the_package_is_importable_without_blender():
    code = "import sys; sys.modules['bpy'] = None; import rppm_addon, rppm_addon.scene; print(rppm_addon.register)"
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, timeout=60, stdout=subprocess.DEVNULL)
