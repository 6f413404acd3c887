# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps that a test can ask of Blender: each function is a step; what it returns must fit into JSON."""

import time

import bpy

renders = {"started": 0, "completed": 0, "cancelled": 0}


def counter(counts: dict[str, int], name: str):
    """A handler that counts its calls, also after another file is opened."""

    def handler(*_: object) -> None:
        counts[name] += 1

    return bpy.app.handlers.persistent(handler)


bpy.app.handlers.render_init.append(counter(renders, "started"))
bpy.app.handlers.render_complete.append(counter(renders, "completed"))
bpy.app.handlers.render_cancel.append(counter(renders, "cancelled"))


def ready() -> bool:
    """Whether the window is laid out, as it is once it has been drawn."""
    return all(min(area.width, area.height) > 1 for area in window().screen.areas) and region("VIEW_3D").height > 1


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def area(kind: str) -> bpy.types.Area:
    """The largest area of a kind in the first window."""
    return max((area for area in window().screen.areas if area.type == kind), key=lambda a: a.width * a.height)


def region(kind: str) -> bpy.types.Region:
    return next(region for region in area(kind).regions if region.type == "WINDOW")


def override(kind: str = "VIEW_3D"):
    """Context in which operators see an area of the window."""
    found = area(kind)
    return bpy.context.temp_override(window=window(), area=found, region=region(kind))


def rectangle(kind: str) -> list[int]:
    """x, y, width, height of an area's main region on the screen, y from the top."""
    found = region(kind)
    return [found.x, window().height - found.y - found.height, found.width, found.height]


def split(kind: str, size: str, wanted: int) -> None:
    """Split an area so that one half's main region has about this ``size`` (width or height)."""
    total = getattr(area(kind), size)
    border = total - getattr(region(kind), size)
    with override(kind):
        bpy.ops.screen.area_split(
            direction="VERTICAL" if size == "width" else "HORIZONTAL", factor=(wanted + border) / total
        )


def keep_smallest(kind: str) -> None:
    """Keep the smallest one of the areas of a kind; the others become text editors."""
    found = sorted((area for area in window().screen.areas if area.type == kind), key=lambda a: a.width * a.height)
    for other in found[1:]:
        other.type = "TEXT_EDITOR"


def evaluate(text: str) -> object:
    """Value of an expression over bpy and the scene."""
    return eval(text, {"bpy": bpy, "scene": window().scene})  # noqa: S307 - tests only


def assign(path: str, value: object) -> None:
    """Set an attribute: ``scene.rppm.samples`` or any path from bpy."""
    owner, name = path.rsplit(".", 1)
    setattr(evaluate(owner), name, value)


def properties_tab(name: str) -> None:
    """Show a tab of the Properties editor, its panels open."""
    area("PROPERTIES").spaces.active.context = name


def render_counts() -> dict[str, int]:
    return dict(renders)


def rendering() -> bool:
    return bpy.app.is_job_running("RENDER")


def save_result(path: str) -> None:
    """Save the last render with the scene's format and view."""
    bpy.data.images["Render Result"].save_render(path, scene=window().scene)


def open_file(path: str) -> None:
    with override():
        bpy.ops.wm.open_mainfile(filepath=path)


def quit_blender() -> None:
    """Leave, a little later so that this step is answered."""

    def leave() -> None:
        with bpy.context.temp_override(window=window()):
            bpy.ops.wm.quit_blender()

    bpy.app.timers.register(leave, first_interval=0.1)


def clock() -> float:
    return time.perf_counter()
