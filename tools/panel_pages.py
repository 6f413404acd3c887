# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the settings of docs/panels/*.md anew: what each panel shows, as Blender and RPPM declare it.

Panels are drawn, without a window, into a layout that lists what it is given; names, tooltips, defaults and ranges are
those of the properties. What stands outside the marks of a page is written by hand. Pictures come from
tools/setting_pairs.py.
"""

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "panels"
BEGIN, END = "<!-- begin: tools/panel_pages.py -->", "<!-- end -->"
TABS = {
    "view_layer": "View Layer", "object": "Object", "modifier": "Modifier", "material": "Material", "world": "World",
}  # fmt: skip
"""Tabs of the Properties editor whose panels share a page; those of the render tab have a page each."""
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "blender")]

import bpy  # noqa: E402
from drawing import RecordingLayout, context_of  # noqa: E402

import rppm_addon  # noqa: E402
from rppm_addon.blender import panels  # noqa: E402
from rppm_addon.blender.panels.base import RppmPanel  # noqa: E402
from rppm_addon.blender.panels.switches import MEANINGS  # noqa: E402
from tools.setting_pairs import PAIRS, Pair  # noqa: E402

OF_BLENDER = {
    "Surface": "The inputs of the shader node that the surface has, as Cycles shows them.",
    "Volume": "The inputs of the shader node that the volume has, as Cycles shows them.",
    "Displacement": "The inputs of the node that displaces the surface, as Cycles shows them.",
    "Preview": "What the world looks like around a few objects.",
    "Shader AOV": "Names of the values that AOV Output nodes of materials give to pictures of their own.",
    "Light Groups": "Names of groups of lights, each of which has a picture of what it alone lights.",
}
"""Contents of the panels that Blender draws by itself, by their titles."""


@dataclass
class Shown:
    """A property as a panel shows it."""

    name: str
    path: str
    declared: bpy.types.Property


@dataclass
class Section:
    """A panel."""

    title: str
    place: str
    parent: str
    shown: dict[str, Shown] = field(default_factory=dict)
    """By path."""
    buttons: dict[str, str] = field(default_factory=dict)
    """Tooltips by text."""


class ListingLayout(RecordingLayout):
    """Keeps where the properties that it is given lie, and what they are called there."""

    heading = ""

    def row(self, heading: str = "", **more: object) -> "ListingLayout":
        """As UILayout has it."""
        part = super().row(**more)
        part.heading = heading
        return part

    def column(self, heading: str = "", **more: object) -> "ListingLayout":
        """As UILayout has it."""
        part = super().column(**more)
        part.heading = heading
        return part

    def prop(self, data: bpy.types.bpy_struct, name: str, text: str | None = None, **more: object) -> None:
        """List a property, under the name that the panel gives it."""
        super().prop(data, name, **more)
        if data.bl_rna.identifier == "RppmSwitches":
            data = data.id_data.rppm
        declared = data.bl_rna.properties[name]
        if declared.is_hidden:
            return
        called = text or self.heading or declared.name
        self.record.section.shown.setdefault(_path(data, name), Shown(called, _path(data, name), declared))

    def operator(self, identifier: str, text: str | None = None, **more: object) -> SimpleNamespace:
        """List a button that has words: the operator's name where the panel gives none."""
        made = super().operator(identifier, text=text or "", **more)
        module, name = identifier.split(".")
        declared = getattr(getattr(bpy.ops, module), name).get_rna_type()
        words = declared.name if text is None else text
        if words and declared.description:
            self.record.section.buttons[words] = declared.description
        return made


def _path(data: bpy.types.bpy_struct, name: str) -> str:
    """As Python finds the property: ``scene.rppm.samples``."""
    owner = data.id_data
    if owner is None or isinstance(owner, bpy.types.Screen):
        return f"space_data.shading.{name}"
    kind = next(
        text
        for kind, text in (
            (bpy.types.Scene, "scene"), (bpy.types.Light, "light"), (bpy.types.Camera, "camera"),
            (bpy.types.World, "world"), (bpy.types.Material, "material"), (bpy.types.Object, "object"),
            (bpy.types.NodeTree, "node_tree"), (bpy.types.ID, "data"),
        )
        if isinstance(owner, kind)
    )  # fmt: skip
    try:
        inner = "" if data == owner else data.path_from_id()
    except ValueError:  # of what add-ons give to view layers Blender knows no path
        inner = f"view_layers.{'rppm' if 'Rppm' in data.bl_rna.identifier else 'cycles'}"
    inner = re.sub(r'\["[^"]*"\]|\[\d+\]', "", inner)
    if inner.startswith("view_layers"):
        kind, inner = "view_layer", inner.removeprefix("view_layers").removeprefix(".")
    return ".".join(part for part in (kind, inner, name) if part)


def sections() -> dict[str, list[tuple[int, Section]]]:
    """Sections, with the levels of their headings, by the name of the page, in the order of the tabs. What is at the
    top of a page of the render tab has the page's own heading, 1."""
    found: dict[str, Section] = {}
    pages: dict[str, list[tuple[int, Section]]] = {}
    contexts = list(_contexts())
    for cls in panels.CLASSES:
        if not issubclass(cls, RppmPanel) or not hasattr(cls, "draw"):
            continue
        section = Section(cls.bl_label, getattr(cls, "bl_context", ""), getattr(cls, "bl_parent_id", ""))
        for context in contexts:
            if cls.poll(context):
                _draw(cls, context, section)
        found[cls.__name__] = section
        level, above = (1 if section.place == "render" else 2), section
        while above.parent in found:
            level, above = level + 1, found[above.parent]
        pages.setdefault(_page_of(cls, found), []).append((level, section))
    return pages


def _page_of(cls: type[bpy.types.Panel], found: dict[str, Section]) -> str:
    place = getattr(cls, "bl_context", "")
    if place == "data":
        return {"RPPM_PT_panorama": "camera", "RPPM_PT_volume_velocity": "volume"}.get(cls.__name__, "light")
    if place in TABS:
        return place
    top = found[cls.__name__]
    while top.parent in found:
        top = found[top.parent]
    return top.title.lower().replace(" ", "_")


def _draw(cls: type[bpy.types.Panel], context: SimpleNamespace, section: Section) -> None:
    panel = cls(bpy.data.scenes[0])
    panel.layout = ListingLayout()
    panel.layout.record.section = section
    for name in ("draw_header", "draw"):
        if hasattr(cls, name):
            getattr(panel, name)(context)


def _contexts() -> Iterator[SimpleNamespace]:
    """Things of every kind, each as if it were selected, with what shows most of a panel."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "RPPM"
    scene.world = bpy.data.worlds.new("World")
    scene.view_layers[0].use_pass_cryptomatte_object = scene.view_layers[0].use_pass_mist = True
    for name in ("time_limit", "photons", "preview_photons", "radius_minimum", "radius_maximum", "cubemap_resolution"):
        setattr(scene.rppm, name, 1 if name != "cubemap_resolution" else 256)
    scene.rppm.adaptive_min_samples = scene.rppm.preview_adaptive_min_samples = 16
    scene.rppm.pixel_filter_type = "GAUSSIAN"
    scene.render.use_simplify = scene.render.use_motion_blur = True
    material = bpy.data.materials.new("Material")
    mesh = bpy.data.objects.new("Mesh", bpy.data.meshes.new("Mesh"))
    scene.collection.objects.link(mesh)
    mesh.data.materials.append(material)
    mesh.modifiers.new("Subdivision", "SUBSURF")
    yield context_of(scene, object=mesh, material=material, world=scene.world, mesh=mesh.data)
    for kind in ("POINT", "SPOT", "SUN", "AREA"):
        data = bpy.data.lights.new(kind.title(), kind)
        if kind == "AREA":
            data.shape = "RECTANGLE"
        thing = bpy.data.objects.new(kind.title(), data)
        scene.collection.objects.link(thing)
        yield context_of(scene, object=thing, light=data, world=scene.world)
    yield context_of(scene, volume=bpy.data.volumes.new("Volume"), world=scene.world)
    data = bpy.data.cameras.new("Camera")
    data.type = "PANO"
    camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(camera)
    for bake_type in ("COMBINED", "DIFFUSE", "NORMAL"):
        scene.rppm.bake_type = bake_type
        yield context_of(scene, object=camera, camera=data, world=scene.world)


def section_text(section: Section, level: int) -> str:
    """A panel in Markdown."""
    parts = [f"{'#' * level} {section.title}\n"] if level > 1 else []
    if section.title in OF_BLENDER:
        parts.append(f"{OF_BLENDER[section.title]}\n")
    for shown in section.shown.values():
        parts.append(_entry(shown))
    for text, tooltip in section.buttons.items():
        parts.append(f"**{text}** (button): {_sentence(tooltip)}\n")
    return "\n".join(parts)


def _entry(shown: Shown) -> str:
    declared = shown.declared
    facts = " · ".join(filter(None, (f"`{shown.path}`", _default(shown), _range(shown))))
    lines = [f"**{shown.name}**: {_sentence(declared.description)}  ", facts, ""]
    if declared.type == "ENUM" and not declared.is_enum_flag:
        kinds = [item for item in declared.enum_items if item.name and item.description]
        lines += [f"- {item.name} (`{item.identifier}`): {_sentence(item.description)}" for item in kinds]
        lines += [""] if kinds else []
    pair = PAIRS.get(shown.path.removeprefix("scene.rppm."))
    if pair is not None:
        lines += [picture(shown.name, pair), ""]
    return "\n".join(lines)


def picture(name: str, pair: Pair) -> str:
    """The pictures of a setting, with its values from left to right, and what they show."""
    file = f"../images/settings/{pair.setting}.jpg"
    return f"![{name}: {', '.join(pair.labels)}]({file})\n\n*{', '.join(pair.labels)}: {pair.caption}*"


def _sentence(text: str) -> str:
    text = " ".join(text.split()) or "no more is said"
    return text if text.endswith((".", "?", "!")) else f"{text}."


def _default(shown: Shown) -> str:
    declared = shown.declared
    name = shown.path.removeprefix("scene.rppm.")
    if declared.type == "BOOLEAN":
        return "" if declared.is_array else f"default {'on' if declared.default else 'off'}"
    if declared.type in {"INT", "FLOAT"} and not declared.is_array:
        if MEANINGS.get(name) and declared.default == 0:
            return f"default {MEANINGS[name].lower()} (0)"
        return f"default {declared.default:g}"
    if declared.type == "ENUM" and declared.default in declared.enum_items:
        return f"default {declared.enum_items[declared.default].name}"
    return ""


def _range(shown: Shown) -> str:
    declared = shown.declared
    if declared.type not in {"INT", "FLOAT"} or declared.is_array:
        return ""
    low, high = declared.hard_min, declared.hard_max
    if high > 1e9:
        return f"{low:g} or more" if abs(low) < 1e9 else ""
    return f"{low:g} to {int(high) if float(high).is_integer() else f'{high:g}'}"


def page(text: str, found: list[tuple[int, Section]]) -> str:
    """A page with what the panels show put in between the two marks; each with the level of its heading."""
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    parts = [section_text(section, level) for level, section in found]
    return f"{before}{BEGIN}\n" + "\n".join(parts).rstrip() + f"\n{END}{after}"


def pages() -> dict[Path, str]:
    """All pages as they should be, by their files."""
    texts = {}
    for name, found in sections().items():
        path = FOLDER / f"{name}.md"
        title = TABS.get(name) or name.replace("_", " ").title()
        # REUSE-IgnoreStart
        empty = f"<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n# {title}\n\n{BEGIN}\n{END}\n"
        # REUSE-IgnoreEnd
        texts[path] = page(path.read_text(encoding="utf-8") if path.exists() else empty, found)
    return texts


if __name__ == "__main__":
    rppm_addon.register()
    FOLDER.mkdir(exist_ok=True)
    for path, text in pages().items():
        path.write_text(text, encoding="utf-8")
    rppm_addon.unregister()
