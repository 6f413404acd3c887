# SPDX-License-Identifier: GPL-3.0-or-later
"""Actions of a user of the extension in this Blender: installs the zip, then starts again and uses it.

Run as ``python as_user.py install ZIP``, then ``... use FOLDER``, with BLENDER_USER_RESOURCES set to the same folder,
empty at first; prints JSON. FOLDER gets here.exr and process.exr, pictures of docs/samples/first_light.py.
"""

import importlib
import json
import os
import sys
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "blender")]
from install_extension import MODULE, install  # noqa: E402 (it is no package)

PACKAGE = f"{MODULE}.rppm_addon"


def module(name: str):
    return importlib.import_module(f"{PACKAGE}.{name}")


def render(picture: Path) -> dict:
    """Render to an EXR; what the render reported."""
    scene = bpy.context.scene
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    reports = module("blender.reports").reports_of(scene.session_uid)
    return {"warnings": list(reports.latest.warnings), "samples": reports.latest.progress.iteration}


def build_scene() -> None:
    """The sample scene, small, and rendered soon."""
    sys.path[:0] = [str(ROOT / "docs" / "samples")]
    # The sample imports the checkout's package, to have its properties saved: here they are the extension's.
    sys.modules["rppm_addon"] = sys.modules[PACKAGE]
    import first_light

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=MODULE)
    scene = bpy.context.scene
    first_light.build(scene)
    del sys.modules["rppm_addon"]
    scene.render.resolution_x, scene.render.resolution_y = 96, 72
    scene.rppm.samples, scene.rppm.photons, scene.rppm.time_limit = 16, 8192, 0.0
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"


def draw_panels() -> list[str]:
    """Draw the panels of each tab, by what is selected; their names."""
    from drawing import context_of, drawn, drawn_panels

    scene = bpy.context.scene
    classes = [cls for cls in module("blender.panels").CLASSES if issubclass(cls, bpy.types.Panel)]
    classes = [cls for cls in classes if cls.bl_space_type == "PROPERTIES"]
    shown = set()
    for thing in scene.objects:
        members = {"object": thing, "world": scene.world, "mesh": None}
        members[thing.type.lower()] = thing.data
        material = next((slot.material for slot in thing.material_slots), None)
        shown |= set(drawn_panels(classes, context_of(scene, **(members | {"material": material}))))
    drawn(module("blender.preferences").RppmPreferences, context_of(scene))
    return sorted(shown)


def apply_presets() -> dict[str, int]:
    """Samples by the name of a preset that came with the extension."""
    samples = {}
    for folder in bpy.utils.preset_paths("rppm"):
        for path in sorted(Path(folder).glob("*.py")):
            bpy.ops.script.execute_preset(filepath=str(path), menu_idname="RPPM_PT_presets")
            samples[path.stem] = bpy.context.scene.rppm.samples
    return samples


def raycast() -> list[str]:
    """List what is read of a Raycast node, where there is one: kinds of nodes, and, from Blender 5.2 on, attributes
    that are exported with a mesh that comes before the material that samples them."""
    if not hasattr(bpy.types, "ShaderNodeRaycast"):
        return []
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=MODULE)
    bpy.ops.object.camera_add()
    bpy.context.scene.camera = bpy.context.object
    for name in ("Asked", "Asking"):
        bpy.ops.mesh.primitive_plane_add()
        bpy.context.object.name = name
        bpy.context.object.data.attributes.new("Heat", "FLOAT", "POINT")
    material = bpy.data.materials.new("Asking")
    bpy.context.object.data.materials.append(material)
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new("ShaderNodeRaycast"), tree.nodes.new("ShaderNodeOutputMaterial")
    read = "Hit Distance"
    if hasattr(node, "sample_attribute_items"):  # Blender 5.2 and later
        read = "Heat"
        node.sample_attribute_items.new("FLOAT", read)
        node.inputs[read].default_value = read
    tree.links.new(node.outputs[read], output.inputs["Surface"])
    scene = module("blender.export").export_scene(bpy.context.evaluated_depsgraph_get())
    meshes = [name for mesh in scene.meshes for name in mesh.attributes]
    return [node.kind for material in scene.materials for node in material.graph.nodes] + meshes + scene.warnings


def use(folder: str) -> dict:
    bpy.ops.preferences.addon_enable(module=MODULE)
    build_scene()
    report = {"blender": bpy.app.version_string, "here": render(Path(folder) / "here.exr")}
    report["panels"] = draw_panels()
    process = module("blender.render_client.renderer_process")
    process.is_used = lambda: True  # as where there is a window
    report["process"] = render(Path(folder) / "process.exr")
    report["device"] = process.renderer_process().device.name
    process.close()
    report["presets"] = apply_presets()
    report["raycast"] = raycast()
    import moderngl

    report["moderngl"] = moderngl.__file__
    engine = module("blender.engine.render_engine").RppmRenderEngine
    report["engine"] = {name: getattr(engine, name) for name in ("bl_use_preview", "bl_use_eevee_viewport")}
    report["engine"]["viewport"] = all(name in vars(engine) for name in ("view_update", "view_draw"))
    bpy.ops.preferences.addon_disable(module=MODULE)
    report["left"] = [name for name in dir(bpy.types) if name.startswith("RPPM_")]
    return report


if __name__ == "__main__":
    print(json.dumps({"install": install, "use": use}[sys.argv[1]](sys.argv[2])), flush=True)
    # bpy 4.2 crashes as Python ends once any class with a property was registered whose update is a function.
    os._exit(0)
