# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws panels without a window: a layout that records what is shown, and insists that it exists."""

from types import SimpleNamespace

import bpy

ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())


class RecordingLayout:
    """Stands in for a UILayout: properties, operators, icons and pointers must be there."""

    def __init__(self, record=None):
        self.record = record or SimpleNamespace(properties=[], labels=[], operators=[], templates=[], popovers=[])

    def _part(self, **_):
        return type(self)(self.record)

    row = column = box = split = grid_flow = _part

    def panel(self, _identifier, default_closed=False):
        """A header and a body, as if it were open."""
        return self._part(), self._part()

    def separator(self, **_):
        pass

    def prop(self, data, name, icon="NONE", **_):
        assert name in data.bl_rna.properties, f"{data} has no {name}"
        assert icon in ICONS
        self.record.properties.append(name)

    def prop_search(self, data, name, search_data, search_name, **_):
        assert search_name in search_data.bl_rna.properties
        self.prop(data, name)

    def menu(self, menu, text="", icon="NONE"):
        assert hasattr(bpy.types, menu) and icon in ICONS

    def label(self, text="", icon="NONE", translate=True):
        assert isinstance(text, str) and icon in ICONS
        self.record.labels.append(text)

    def operator(self, identifier, text="", icon="NONE"):
        module, name = identifier.split(".")
        properties = getattr(getattr(bpy.ops, module), name).get_rna_type().properties
        assert icon in ICONS
        shown = SimpleNamespace(_identifier=identifier, _names=set(properties.keys()))
        self.record.operators.append(shown)
        return shown

    def popover(self, panel, icon="NONE", **_):
        assert hasattr(bpy.types, panel) and icon in ICONS
        self.record.popovers.append(panel)

    def template_list(self, kind, _identifier, data, name, active_data, active_name, **_):
        assert hasattr(bpy.types, kind)
        assert name in data.bl_rna.properties and active_name in active_data.bl_rna.properties
        self.record.properties.append(name)

    def template_preview(self, owner):
        self.record.templates.append(owner)

    def template_curve_mapping(self, data, name):
        assert isinstance(getattr(data, name), bpy.types.CurveMapping)
        self.record.properties.append(name)

    def template_node_view(self, tree, node, socket):
        assert node.id_data == tree and socket.node == node
        self.record.templates.append(socket)


def context_of(scene, **members):
    """Return a context of the Properties editor with the members that panels ask for."""
    nothing = dict.fromkeys(("light", "camera", "volume", "material", "world", "object"))
    return SimpleNamespace(
        **{
            "engine": scene.render.engine,
            "scene": scene,
            "view_layer": scene.view_layers[0],
            "region": SimpleNamespace(width=400),
            "preferences": SimpleNamespace(
                system=SimpleNamespace(ui_scale=1.0),  # 0 without a window
                view=SimpleNamespace(show_developer_ui=True),
            ),
        }
        | nothing
        | members
    )


def preferences_context():
    """A context of the Preferences editor."""
    system = SimpleNamespace(ui_scale=1.0)  # 0 without a window
    return SimpleNamespace(region=SimpleNamespace(width=500), preferences=SimpleNamespace(system=system))


def drawn(cls, context):
    """Draw a panel (or preferences, or another class with draw) and return the record of what it shows."""
    panel = cls(bpy.data.scenes[0])  # an instance needs some RNA; which does not matter
    panel.layout = RecordingLayout()
    for name in ("draw_header", "draw_header_preset"):
        if hasattr(cls, name):
            getattr(panel, name)(context)
    panel.draw(context)
    for button in panel.layout.record.operators:
        assert set(vars(button)) - {"_identifier", "_names"} <= button._names, button
    return panel.layout.record


def identifiers(record):
    """Names of the operators that buttons of a record call."""
    return [button._identifier for button in record.operators]


def drawn_panels(classes, context):
    """Records by the name of the panel, of those that show in the context."""
    return {cls.__name__: drawn(cls, context) for cls in classes if hasattr(cls, "poll") and cls.poll(context)}
