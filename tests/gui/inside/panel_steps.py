# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps about the Properties editor and the preferences."""

import importlib
import types

import bpy
from window_steps import area, override, window


def _addon() -> str:
    """The module that Blender knows the extension by."""
    return next(addon.module for addon in bpy.context.preferences.addons if addon.module.endswith(".rppm"))


def open_all_panels() -> int:
    """Register the engine's panels anew without any that starts closed; returns how many there are."""
    classes = importlib.import_module(f"{_addon()}.rppm_addon.blender.panels").CLASSES
    for cls in reversed(classes):
        bpy.utils.unregister_class(cls)
    for cls in classes:
        if hasattr(cls, "bl_options") and issubclass(cls, bpy.types.Panel):
            cls.bl_options = set()
        bpy.utils.register_class(cls)
    return len(classes)


def replace_area(kind: str, by: str) -> None:
    """Have the largest area of a kind show another editor."""
    area(kind).type = by


def make_active(name: str) -> None:
    """Make an object the only one selected, and active."""
    layer = window().view_layer
    for thing in layer.objects:
        thing.select_set(thing.name == name)
    layer.objects.active = layer.objects[name]


def scroll_to(page: int) -> None:
    """Show a page of the Properties editor, 0 being the top."""
    with override("PROPERTIES"):
        bpy.ops.view2d.scroll_up(deltax=0, deltay=100000)
        for _ in range(page):
            bpy.ops.view2d.scroll_down(deltax=0, deltay=0, page=True)


def press_button(operator: str, **values: object) -> list[str]:
    """Run an operator as a button in the Properties editor does."""
    module, name = operator.split(".")
    with override("PROPERTIES"):
        return list(getattr(getattr(bpy.ops, module), name)(**values))


def show_preferences() -> None:
    """Show the extension's own preferences in the largest area."""
    area("PROPERTIES").type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "RPPM"
    with bpy.context.temp_override(window=window(), area=area("PREFERENCES")):
        bpy.ops.preferences.addon_expand(module=_addon())


def _renderer_process() -> types.ModuleType:
    return importlib.import_module(f"{_addon()}.rppm_addon.blender.render_client.renderer_process")


def end_renderer() -> None:
    """End the renderer process, as another file does."""
    _renderer_process().close()


def renderer_state() -> list[str]:
    """State and device of the renderer process, as the preferences show them."""
    process = _renderer_process().renderer_process()
    return [process.state.name, process.device.name if process.device else "", process.error]


def draw_window() -> None:
    """Draw all of the window, as it is now."""
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)


def readings() -> dict[str, object]:
    """Return the iterations and watts that the viewport has last reported of the scene; empty without a report."""
    scene = window().scene
    reports = importlib.import_module(f"{_addon()}.rppm_addon.blender.reports").reports_of(scene.session_uid)
    found = reports.viewport
    return (
        {} if found is None else {"iterations": found.progress.iteration, "watts": found.photon_statistics.source_watts}
    )
