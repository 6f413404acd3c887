# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations in which each kind of thing changes from frame to frame; frames are those of FRAMES.

Each function fills a scene that has a floor, a wall and a light (``stage``). They are deterministic: positions are
written out, and physics is baked into keyframes.
"""

import math
from pathlib import Path

import bpy
import numpy as np
from blender_scenes import add_light, add_mesh, add_object, collect, new_image, save_png, set_world, show_collection
from node_trees import add_node, geometry_nodes, link, new_material, node_group, surface

FRAMES = range(1, 5)


def stage(scene: bpy.types.Scene) -> None:
    """A floor, a wall, an area light and a camera that looks at them from the front."""
    set_world(scene, (0.05, 0.06, 0.08))
    white = material("White", "ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.6, 1.0))
    add_mesh(scene, "Floor", [(-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0)], material=white)
    add_mesh(scene, "Wall", [(-3, 3, 0), (3, 3, 0), (3, 3, 4), (-3, 3, 4)], material=white)
    light = add_light(scene, "AREA", "Light", energy=200.0, size=0.5)
    light.location, light.rotation_euler = (1.0, -1.0, 3.5), (0.2, 0.25, 0.0)
    scene.camera.location, scene.camera.rotation_euler = (0.0, -5.0, 2.2), (math.radians(74.0), 0.0, 0.0)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.frame_set(FRAMES[0])


def material(name: str, kind: str, **inputs: object) -> bpy.types.Material:
    """A material of one shader node, which is named Shader."""
    return surface(kind, "Shader", new_material(name), **inputs)[0]


def glass() -> bpy.types.Material:
    return material("Glass", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.45)


def mirror() -> bpy.types.Material:
    return material("Mirror", "ShaderNodeBsdfAnisotropic", Color=(0.9, 0.9, 0.9, 1.0), Roughness=0.0)


def keyed(owner: object, name: str, *values: object, index: int = -1) -> None:
    """Keyframes, one a frame."""
    for frame, value in zip(FRAMES, values, strict=False):
        if index < 0:
            setattr(owner, name, value)
        else:
            getattr(owner, name)[index] = value
        owner.keyframe_insert(name, index=index, frame=frame)


def grid(scene: bpy.types.Scene, name: str, size: float, cells: int, **values: object) -> bpy.types.Object:
    """A flat square of cells x cells faces."""
    side = np.linspace(-size, size, cells + 1)
    points = [(x, y, 0.0) for y in side for x in side]
    row = cells + 1
    faces = [(k, k + 1, k + row + 1, k + row) for j in range(cells) for k in range(j * row, j * row + cells)]
    return add_mesh(scene, name, points, faces, **values)


def ball(scene: bpy.types.Scene, name: str, radius: float, around: int = 16, **values: object) -> bpy.types.Object:
    """A sphere, its vertices in the same order each time, which bmesh's operators do not promise."""
    rings = around // 2
    points = [(0.0, 0.0, radius)]
    for j in range(1, rings):
        height, across = radius * math.cos(math.pi * j / rings), radius * math.sin(math.pi * j / rings)
        points += [
            (across * math.cos(math.tau * i / around), across * math.sin(math.tau * i / around), height)
            for i in range(around)
        ]
    points.append((0.0, 0.0, -radius))
    faces = []
    for i in range(around):
        after = (i + 1) % around
        faces.append((0, 1 + i, 1 + after))
        for j in range(rings - 2):
            here = 1 + j * around
            faces.append((here + i, here + around + i, here + around + after, here + after))
        last = 1 + (rings - 2) * around
        faces.append((last + i, len(points) - 1, last + after))
    made = add_mesh(scene, name, points, faces, **values)
    made.data.shade_smooth()
    return made


def wave(scene: bpy.types.Scene, folder: Path) -> None:
    """The surface of water, by the Wave modifier, and by geometry nodes that look at the time."""
    water = grid(scene, "Water", 2.0, 16, location=(-1.0, 0.0, 0.6), material=glass())
    modifier = water.modifiers.new("Wave", "WAVE")
    modifier.height, modifier.width, modifier.speed, modifier.time_offset = 0.2, 0.9, 0.2, -20.0
    lake = grid(scene, "Lake", 1.0, 8, location=(1.8, 0.0, 0.4), material=bpy.data.materials["Glass"])
    (shift,) = geometry_nodes(lake, "GeometryNodeSetPosition")
    time = add_node(shift.id_data, "GeometryNodeInputSceneTime")
    noise = add_node(shift.id_data, "ShaderNodeTexNoise", noise_dimensions="4D", W=time.outputs["Seconds"])
    link(shift.id_data, noise.outputs["Color"], shift.inputs["Offset"])


def spotlight(scene: bpy.types.Scene, folder: Path) -> None:
    """A spot and the camera go round a mirror and a glass."""
    ball(scene, "Mirror", 0.7, location=(-0.6, 0.4, 0.7), material=mirror())
    ball(scene, "Glass", 0.5, location=(0.8, -0.4, 0.6), material=glass())
    spot = add_light(scene, "SPOT", "Spot", energy=800.0, spot_size=0.9)
    keyed(spot, "location", *((x, -2.0, 3.0) for x in (-1.0, -0.5, 0.5, 1.0)))
    keyed(spot, "rotation_euler", *((0.6, y, 0.0) for y in (-0.3, -0.1, 0.1, 0.3)))
    keyed(scene.camera, "location", *((x, -5.0, 2.2) for x in (-0.4, -0.2, 0.2, 0.4)))
    keyed(scene.camera.data, "lens", 50.0, 45.0, 40.0, 35.0)


def rigid_bodies(scene: bpy.types.Scene, folder: Path) -> None:
    """Boxes that fall on each other, their motion baked into keyframes."""
    floor = bpy.data.objects["Floor"]
    boxes = [ball(scene, f"Body {k}", 0.4, 6, location=(0.25 * k - 0.5, 0.1 * k, 0.5 + 0.85 * k)) for k in range(4)]
    bpy.ops.rigidbody.world_add()
    scene.rigidbody_world.time_scale = 4.0
    for thing, kind in ((floor, "PASSIVE"), *((box, "ACTIVE") for box in boxes)):
        with bpy.context.temp_override(object=thing, active_object=thing, selected_objects=[thing]):
            bpy.ops.rigidbody.object_add(type=kind)
    # Blender's own operator bakes into keyframes only where there is a window.
    moved = {frame: _places_at(scene, boxes, frame) for frame in FRAMES}
    bpy.ops.rigidbody.world_remove()
    for index, box in enumerate(boxes):
        box.rotation_mode = "QUATERNION"
        for name, part in (("location", 0), ("rotation_quaternion", 1)):
            keyed(box, name, *(moved[frame][index][part] for frame in FRAMES))


def _places_at(scene: bpy.types.Scene, bodies: list[bpy.types.Object], frame: int) -> list[tuple]:
    """Location and rotation of simulated bodies; frames are to be asked for in their order."""
    scene.frame_set(frame)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return [body.evaluated_get(depsgraph).matrix_world.decompose()[:2] for body in bodies]


def armature(scene: bpy.types.Scene, folder: Path) -> None:
    """A stalk that bends with its bones."""
    stalk = ball(scene, "Stalk", 0.5, location=(0.0, 0.0, 1.0), scale=(0.5, 0.5, 2.0), material=glass())
    skeleton = add_object(scene, "Skeleton", bpy.data.armatures.new("Skeleton"))
    bpy.context.view_layer.objects.active = skeleton
    bpy.ops.object.mode_set(mode="EDIT")
    for name, low, high in (("Root", 0.0, 1.0), ("Tip", 1.0, 2.0)):
        bone = skeleton.data.edit_bones.new(name)
        bone.head, bone.tail = (0.0, 0.0, low), (0.0, 0.0, high)
    skeleton.data.edit_bones["Tip"].parent = skeleton.data.edit_bones["Root"]
    bpy.ops.object.mode_set(mode="OBJECT")
    tip = skeleton.pose.bones["Tip"]
    tip.rotation_mode = "XYZ"
    keyed(tip, "rotation_euler", *((angle, 0.0, 0.3 * angle) for angle in (0.0, 0.4, 0.8, 1.2)))
    for name, from_height, to_height in (("Root", -1.0, 0.0), ("Tip", 0.0, 1.0)):
        indices = [v.index for v in stalk.data.vertices if from_height <= 2.0 * v.co.z <= to_height]
        stalk.vertex_groups.new(name=name).add(indices, 1.0, "REPLACE")
    stalk.modifiers.new("Bend", "ARMATURE").object = skeleton


def instances(scene: bpy.types.Scene, folder: Path) -> None:
    """Instances come and go: by geometry nodes, of a collection, and of a particle system."""
    pebble = ball(scene, "Pebble", 0.25, 8, location=(10.0, 0.0, 0.0), material=glass())
    tree, _, last = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    frame = add_node(tree, "GeometryNodeInputSceneTime").outputs["Frame"]
    turn = add_node(tree, "ShaderNodeMath", operation="PINGPONG", Value=frame)
    turn.inputs[1].default_value = 3.0  # 1, 2, 3, 2 of them
    line = add_node(tree, "GeometryNodeMeshLine", Count=turn.outputs[0], Offset=(0.6, 0.2, 0.0))
    line.inputs["Start Location"].default_value = (-2.0, 0, 0.3)
    source = add_node(tree, "GeometryNodeObjectInfo", Object=pebble).outputs["Geometry"]
    place = add_node(tree, "GeometryNodeInstanceOnPoints", Points=line.outputs[0], Instance=source)
    link(tree, place.outputs[0], last.inputs[0])
    add_mesh(scene, "Row").modifiers.new("Row", "NODES").node_group = tree

    group = collect(scene, ball(scene, "Member", 0.3, 8, location=(0.0, 0.0, 0.0)))
    for k, shown in enumerate(((1, 0, 1, 0), (0, 0, 1, 1))):
        empty = show_collection(scene, group, location=(0.8 * k, 1.0, 0.3))
        for name in ("hide_render", "hide_viewport"):
            keyed(empty, name, *(not x for x in shown))

    emitter = grid(scene, "Emitter", 0.8, 2, location=(1.4, 0.0, 1.2))
    with bpy.context.temp_override(object=emitter, active_object=emitter):
        bpy.ops.object.particle_system_add()
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 6, 1, 4, 2
    settings.physics_type, settings.render_type, settings.instance_object = "NO", "OBJECT", pebble
    settings.particle_size, settings.emit_from = 0.6, "VERT"


def topology(scene: bpy.types.Scene, folder: Path) -> None:
    """Metaballs that flow together, a remeshed body and a body that another one bites into."""
    data = bpy.data.metaballs.new("Drops")
    data.resolution = data.render_resolution = 0.2
    for x in (-0.4, 0.4):
        element = data.elements.new()
        element.co, element.radius = (x, 0.0, 0.0), 0.7
    drops = add_object(scene, "Drops", data, location=(-1.2, 0.0, 0.9))
    drops.data.materials.append(glass())
    sister = add_object(scene, "Drops.001", bpy.data.metaballs.new("Sister"))
    sister.data.elements.new().radius = 0.8
    keyed(sister, "location", *((x, 0.3, 1.2) for x in (-3.0, -2.2, -1.6, -1.0)))

    body = ball(scene, "Body", 0.7, location=(0.6, 0.3, 0.8))
    remesh = body.modifiers.new("Remesh", "REMESH")
    remesh.mode = "VOXEL"
    keyed(remesh, "voxel_size", 0.3, 0.25, 0.2, 0.15)

    bitten = ball(scene, "Bitten", 0.6, location=(1.9, 0.0, 0.7), material=mirror())
    tooth = ball(scene, "Tooth", 0.4, 8, hide_render=True)
    tooth.hide_viewport = True
    keyed(tooth, "location", *((1.9, -0.2, z) for z in (1.8, 1.4, 1.2, 1.0)))
    cut = bitten.modifiers.new("Cut", "BOOLEAN")
    cut.object, cut.operation, cut.solver = tooth, "DIFFERENCE", "EXACT"


def materials(scene: bpy.types.Scene, folder: Path) -> None:
    """Colors, roughness, emission, light and world change, and a light goes out."""
    paint = material("Paint", "ShaderNodeBsdfPrincipled", Roughness=0.8)
    ball(scene, "Painted", 0.6, location=(-1.2, 0.0, 0.6), material=paint)
    shader = paint.node_tree.nodes["Shader"]
    keyed(shader.inputs["Base Color"], "default_value", *((r, 0.3, 0.1, 1.0) for r in (0.1, 0.4, 0.7, 0.9)))
    keyed(shader.inputs["Roughness"], "default_value", 0.9, 0.55, 0.45, 0.0)  # deposits photons, then is traced
    keyed(shader.inputs["Metallic"], "default_value", 0.0, 0.0, 0.5, 1.0)
    glow = material("Glow", "ShaderNodeEmission")
    ball(scene, "Glowing", 0.3, 8, location=(0.3, -0.4, 0.5), material=glow)
    keyed(glow.node_tree.nodes["Shader"].inputs["Strength"], "default_value", 0.0, 5.0, 5.0, 0.0)
    noisy = new_material("Noisy")
    noise = add_node(noisy.node_tree, "ShaderNodeTexNoise", "Noise", noise_dimensions="4D")
    surface("ShaderNodeBsdfDiffuse", "Shader", noisy, Color=noise.outputs["Color"])
    noise.inputs["W"].driver_add("default_value").driver.expression = "frame * 0.5"
    ball(scene, "Driven", 0.4, 8, location=(1.4, 0.0, 0.4), material=noisy)
    light = bpy.data.objects["Light"]
    keyed(light.data, "energy", 200.0, 100.0, 0.0, 50.0)
    keyed(light.data, "color", (1, 1, 1), (1, 0.5, 0.2), (1, 1, 1), (0.2, 0.5, 1))
    second = add_light(scene, "POINT", "Second", energy=60.0)
    for name in ("hide_render", "hide_viewport"):
        keyed(second, name, True, False, False, True)
    keyed(scene.world.node_tree.nodes["Background"].inputs["Strength"], "default_value", 1.0, 1.0, 2.0, 0.0)


def visibility(scene: bpy.types.Scene, folder: Path) -> None:
    """Objects come and go, for all and for some kinds of rays only, until there is nothing to see."""
    left, middle, right = (
        ball(scene, name, 0.5, location=(1.2 * k - 1.2, 0.0, 0.5), material=bpy.data.materials["White"])
        for k, name in enumerate(("Left", "Middle", "Right"))
    )
    for name in ("hide_render", "hide_viewport"):
        keyed(left, name, False, True, False, True)
        keyed(right, name, False, False, True, True)
        for stays in ("Floor", "Wall"):
            keyed(bpy.data.objects[stays], name, False, False, False, True)
    keyed(middle, "visible_camera", True, False, True, False)
    keyed(middle, "visible_shadow", True, True, False, False)
    keyed(right, "is_holdout", False, True, False, False)
    keyed(right, "is_shadow_catcher", True, False, False, False)


def cameras(scene: bpy.types.Scene, folder: Path) -> None:
    """Markers switch cameras: a pinhole, a lens, an orthographic one and a panorama."""
    ball(scene, "Glass", 0.6, location=(0.0, 0.0, 0.7), material=glass())
    for k, frame in enumerate(FRAMES):
        data = bpy.data.cameras.new(f"Camera {k}")
        camera = add_object(scene, data.name, data, location=(0.3 * k, -4.0, 1.5), rotation_euler=(1.4, 0.0, 0.05 * k))
        scene.timeline_markers.new(f"Cut {k}", frame=frame).camera = camera
        if k == 1:
            data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = True, 4.0, 0.5
        elif k == 2:
            data.type, data.ortho_scale = "ORTHO", 4.0
        elif k == 3:
            data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"


def image_sequence(scene: bpy.types.Scene, folder: Path) -> None:
    """Pictures that change with the frame, on a surface and as light from a world."""
    generator = np.random.default_rng(1)
    for frame in FRAMES:
        picture = new_image("Frame", generator.random((4, 4, 4), np.float32))
        save_png(picture, folder / f"picture_{frame:04d}.png")
        bpy.data.images.remove(picture)
    sequence = bpy.data.images.load(str(folder / "picture_0001.png"))
    sequence.source = "SEQUENCE"
    shown, tree = new_material("Shown"), scene.world.node_tree
    pictures = add_node(shown.node_tree, "ShaderNodeTexImage", "Picture", image=sequence)
    surface("ShaderNodeBsdfDiffuse", "Shader", shown, Color=pictures.outputs["Color"])
    sky = add_node(tree, "ShaderNodeTexEnvironment", "Picture", image=sequence)
    link(tree, sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    for user in (pictures.image_user, sky.image_user):
        user.frame_duration, user.frame_start, user.use_auto_refresh = len(FRAMES), FRAMES[0], True
    screen = add_mesh(scene, "Screen", [(-1, 0, 0), (1, 0, 0), (1, 0, 2), (-1, 0, 2)], material=shown)
    layer = screen.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])


def nothing(scene: bpy.types.Scene, folder: Path) -> None:
    """Nothing changes."""
    ball(scene, "Glass", 0.6, location=(0.0, 0.0, 0.7), material=glass())


ANIMATIONS = (
    wave, spotlight, rigid_bodies, armature, instances, topology, materials, visibility, cameras, image_sequence,
    nothing,
)  # fmt: skip
