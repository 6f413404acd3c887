# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles, hair and physics as Quick Effects and the physics tab give them."""

import functools

import bpy

from .files import ball, cube, file, monkey, plain, select, start


def _particles(kind: str, values: dict[str, object]) -> None:
    scene = start()
    thing = monkey()
    thing.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = thing.particle_systems[0].settings
    settings.type, settings.count = kind, 60
    scene.render.hair_type = "STRAND"
    if "instance_object" in values or values.get("render_type") == "COLLECTION":
        small = ball(plain((0.1, 0.3, 0.8)))
        small.scale = (0.5, 0.5, 0.5)
        small.location = (0.0, 5.0, 0.0)
        values = {**values, "instance_object": small} if values["render_type"] == "OBJECT" else values
        if values["render_type"] == "COLLECTION":
            group = bpy.data.collections.new("Group")
            group.objects.link(small)
            values = {**values, "instance_collection": group}
    for name, value in values.items():
        setattr(settings, name, value)
    if kind == "EMITTER":
        settings.frame_end = 1
        scene.frame_set(1)
        scene.frame_set(4)


for name, kind, values in (
    ("emitter", "EMITTER", {}),
    ("emitter_objects", "EMITTER", {"render_type": "OBJECT", "instance_object": None, "particle_size": 0.2}),
    ("emitter_collection", "EMITTER", {"render_type": "COLLECTION", "particle_size": 0.2}),
    ("emitter_none", "EMITTER", {"render_type": "NONE"}),
    ("emitter_path", "EMITTER", {"render_type": "PATH"}),
    ("hair", "HAIR", {}),
    ("hair_thick", "HAIR", {"root_radius": 5.0, "hair_length": 0.6}),
    ("hair_children", "HAIR", {"child_type": "SIMPLE", "hair_length": 0.5, "rendered_child_count": 10}),
    ("hair_interpolated", "HAIR", {"child_type": "INTERPOLATED", "hair_length": 0.5, "rendered_child_count": 10}),
    ("hair_advanced", "HAIR", {"use_advanced_hair": True, "hair_length": 0.5}),
    ("hair_objects", "HAIR", {"render_type": "OBJECT", "instance_object": None, "particle_size": 0.2}),
    ("hair_collection", "HAIR", {"render_type": "COLLECTION", "particle_size": 0.2}),
):
    file(f"particles_{name}", functools.partial(_particles, kind, values))


def _without_emitter() -> None:
    _particles("HAIR", {"hair_length": 0.5})
    bpy.data.objects["Suzanne"].show_instancer_for_render = False


file("particles_hair_without_emitter", _without_emitter)


def _quick(kind: str) -> None:
    scene = start()
    select(monkey())
    if kind == "fur":
        bpy.ops.object.quick_fur(radius=0.02, length=0.3)
        return
    getattr(bpy.ops.object, f"quick_{kind}")()
    for frame in range(1, 6):
        scene.frame_set(frame)


for kind in ("fur", "explode", "smoke", "liquid"):
    file(f"quick_{kind}", functools.partial(_quick, kind), alone=kind in {"smoke", "liquid"})


def _physics(kind: str) -> None:
    scene = start()
    thing = cube(1.0)
    thing.location.z = 0.5
    if kind.startswith("rigid"):
        bpy.ops.rigidbody.object_add(type=kind.partition("_")[2].upper())
    elif kind in {"cloth", "soft_body"}:
        thing.modifiers.new("Physics", kind.upper())
    elif kind == "dynamic_paint":
        thing.modifiers.new("Physics", "DYNAMIC_PAINT")
    for frame in range(1, 9):
        scene.frame_set(frame)


for kind in ("rigid_active", "rigid_passive", "cloth", "soft_body", "dynamic_paint"):
    file(f"physics_{kind}", functools.partial(_physics, kind))
