# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in which the properties of Blender and Cycles matter to a picture.

Each stage is a function of an empty scene, with a camera at (0, 0, 5) that looks down, and of a folder for files.
"""

import bpy
import numpy as np
from blender_scenes import add_light, add_mesh, add_object, collect, new_image, save_png, set_world, show_collection
from node_trees import add_node, geometry_nodes, link, new_material, surface
from support.media.vdb_files import write_vdb
from support.moving import animate, blur

CUBE = (
    [(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)],
    [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)],
)


def _white(name="White"):
    return surface("ShaderNodeBsdfPrincipled", material=new_material(name), Roughness=0.4)[0]


def _world_of_colors(scene):
    world = set_world(scene, (0.3, 0.4, 0.5))
    tree = world.node_tree
    coordinates = add_node(tree, "ShaderNodeTexCoord")
    link(tree, coordinates.outputs["Generated"], tree.nodes["Background"].inputs["Color"])
    return world


def _floor(scene, material=None):
    floor = add_mesh(scene, "Floor", material=material or _white("Floor"), location=(0.0, 0.0, -0.6), scale=(4, 4, 1))
    floor.data.uv_layers.new(name="UVMap")
    return floor


def _all_passes(layer):
    for prop in layer.bl_rna.properties:
        if prop.identifier.startswith("use_pass_") and prop.type == "BOOLEAN":
            setattr(layer, prop.identifier, True)
    for owner in (layer.rppm, getattr(layer, "cycles", None)):
        for prop in owner.bl_rna.properties if owner is not None else ():
            if "pass" in prop.identifier and prop.type == "BOOLEAN":
                setattr(owner, prop.identifier, True)


def lamps(scene, folder):
    """A cube on a floor under lights of all kinds, in light groups, before a world with mist; all passes are on."""
    _floor(scene)
    cube = add_mesh(scene, "Cube", *CUBE, material=_white(), location=(0.7, 0.0, 0.0))
    other = add_mesh(scene, "Other", *CUBE, material=_white(), location=(-0.9, 0.3, 0.1))
    places = {"AREA": (0.0, 0.0, 2.0), "POINT": (-1.5, 1.0, 1.0), "SPOT": (1.5, -1.0, 2.5), "SUN": (0.0, 0.0, 3.0)}
    for kind, place in places.items():
        lamp = add_light(scene, kind, kind.title(), energy=2.0 if kind == "SUN" else 60.0)
        lamp.location, lamp.rotation_euler, lamp.lightgroup = place, (0.3, 0.2, 0.0), "Lamps"
    scene.objects["Area"].data.shape, scene.objects["Area"].data.size_y = "RECTANGLE", 0.5
    world = _world_of_colors(scene)
    world.lightgroup = "Sky"
    layer = scene.view_layers[0]
    for name in ("Lamps", "Sky"):
        layer.lightgroups.add(name=name)
    for owner, held in (("receiver_collection", cube), ("blocker_collection", other)):
        linked = bpy.data.collections.new(owner)
        linked.objects.link(held)
        setattr(scene.objects["Area"].light_linking, owner, linked)
    _all_passes(layer)
    aov = layer.aovs.add()
    aov.name = "Mask"
    add_node(_white("Masked").node_tree, "ShaderNodeOutputAOV", Value=0.5).aov_name = "Mask"


def lens(scene, folder):
    """A camera out of focus, which has no frame but a border, over a transparent film."""
    _floor(scene).scale = (0.6, 0.6, 1.0)
    add_mesh(scene, "Cube", *CUBE, material=_white())
    lamp = add_light(scene, "AREA", energy=100.0)
    if hasattr(lamp.data, "use_temperature"):
        lamp.data.use_temperature = True
    _world_of_colors(scene)
    focus = add_object(scene, "Focus", None, location=(0.0, 0.0, 2.0))
    focus.hide_render = False
    scene.camera.data.sensor_fit = "VERTICAL"
    dof = scene.camera.data.dof
    dof.use_dof, dof.aperture_fstop, dof.focus_distance, dof.aperture_blades = True, 0.5, 3.0, 5
    render = scene.render
    render.film_transparent, render.use_border, render.border_max_x = True, True, 0.8
    render.resolution_percentage = 90


def orthographic(scene, folder):
    """An orthographic camera above a cube."""
    lens(scene, folder)
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 3.0


def panoramas(scene, folder):
    """A camera that looks all around."""
    lens(scene, folder)
    scene.camera.data.type = "PANO"
    owner = scene.camera.data if hasattr(scene.camera.data, "panorama_type") else scene.camera.data.cycles
    owner.panorama_type = "FISHEYE_LENS_POLYNOMIAL"


def equirectangular(scene, folder):
    """A part of the whole way around."""
    panoramas(scene, folder)
    scene.camera.data.panorama_type = "EQUIRECTANGULAR"


def cylinder(scene, folder):
    """A cylinder around the camera."""
    panoramas(scene, folder)
    scene.camera.data.panorama_type = "CENTRAL_CYLINDRICAL"


def eyes(scene, folder):
    """Stereo 3D."""
    lens(scene, folder)
    scene.render.use_multiview = True


def panoramic_eyes(scene, folder):
    """Stereo all around."""
    equirectangular(scene, folder)
    scene.render.use_multiview = True
    scene.camera.data.stereo.use_spherical_stereo = True


def moving(scene, folder):
    """Things, a lamp and the camera move while the shutter is open."""
    _floor(scene)
    cube = add_mesh(scene, "Cube", *CUBE, material=_white())
    animate(cube, "location", (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.3, 0.0, 0.0))
    bent = add_mesh(scene, "Bent", *CUBE, material=_white(), location=(-1.0, 1.0, 0.0))
    bent.shape_key_add(name="Basis")
    key = bent.shape_key_add(name="Bent")
    key.data[0].co = (0.9, 0.9, 0.9)
    for frame, value in ((9, 0.0), (10, 0.3), (11, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    animate(scene.camera, "location", (0.0, 0.0, 5.0), (0.1, 0.0, 5.0), (0.4, 0.0, 5.0))
    random = np.random.default_rng(1).random((3, 3, 3, 3))
    grids = {"density": random[..., 0], "velocity": random, "velocityother": 2.0 * random}
    wind = bpy.data.volumes.new("Wind")
    wind.filepath = str(write_vdb(folder / "wind.vdb", np.diag([0.2, 0.2, 0.2, 1.0]), **grids))
    wind.grids.load()  # Blender looks up the grid of velocities
    wind.materials.append(_smoke("Wind"))
    add_object(scene, "Wind", wind, location=(1.0, 1.0, 0.0))
    add_light(scene, "AREA", energy=100.0)
    _world_of_colors(scene)
    blur()
    scene.cycles.rolling_shutter_type = "TOP"


def strands(scene, folder):
    """Hair, curves, points and text."""
    _floor(scene)
    skin = add_mesh(scene, "Skin", material=_white())
    skin.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = skin.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 20, 0.5
    settings.child_type, settings.rendered_child_count, settings.child_percent = "SIMPLE", 2, 2
    settings.root_radius, settings.tip_radius = 1.0, 0.3
    places = np.random.default_rng(1).random((5 * 6, 3)).astype(np.float32)
    curves = bpy.data.hair_curves.new("Tuft")
    curves.add_curves([6] * 5)
    curves.attributes["position"].data.foreach_set("vector", places.reshape(-1))
    curves.materials.append(_white())
    add_object(scene, "Tuft", curves)
    cloud = add_mesh(scene, "Cloud", location=(0.0, 1.0, 0.0))
    geometry_nodes(cloud, "GeometryNodeMeshToPoints")
    for kind in ("CURVE", "FONT", "SURFACE"):
        data = bpy.data.curves.new(kind, kind)
        if kind == "FONT":
            data.body = "ab"
        elif kind == "CURVE":
            data.dimensions = "3D"
            spline = data.splines.new("BEZIER")
            spline.bezier_points.add(1)
            spline.bezier_points[1].co = spline.bezier_points[1].handle_left = (1.0, 1.0, 0.5)
            data.bevel_depth = 0.1
        else:
            spline = data.splines.new("NURBS")
            spline.points.add(3)
        data.materials.append(_white())
        add_object(scene, kind.title(), data)
    ball = bpy.data.metaballs.new("Meta")
    ball.elements.new()
    ball.materials.append(_white())
    add_object(scene, "Meta", ball)
    add_light(scene, "AREA", energy=100.0)
    _world_of_colors(scene)


def volumes(scene, folder):
    """A cloud of a file, a cube of fog that varies and a world of thin fog; the view layer has passes of volumes."""
    values = np.random.default_rng(1).random((6, 6, 6)).astype(np.float32)
    cloud = bpy.data.volumes.new("Cloud")
    cloud.filepath = str(write_vdb(folder / "cloud.vdb", np.diag([0.3, 0.3, 0.3, 1.0]), density=values))
    cloud.materials.append(_smoke("Cloud"))
    add_object(scene, "Cloud", cloud, location=(-1.5, -1.0, 0.0))
    add_mesh(scene, "Fog", *CUBE, material=_smoke("Fog", varied=True), location=(1.0, 0.0, 0.0))
    _floor(scene)
    add_light(scene, "POINT", energy=200.0)
    world = _world_of_colors(scene)
    fog = add_node(world.node_tree, "ShaderNodeVolumeScatter", Density=0.05)
    output = next(node for node in world.node_tree.nodes if node.type == "OUTPUT_WORLD")
    link(world.node_tree, fog.outputs[0], output.inputs["Volume"])
    _all_passes(scene.view_layers[0])


def _smoke(name, varied=False):
    material = new_material(name)
    tree = material.node_tree
    smoke = add_node(tree, "ShaderNodeVolumePrincipled", Density=2.0)
    if varied:
        noise = add_node(tree, "ShaderNodeTexNoise", Scale=3.0)
        link(tree, noise.outputs[0], smoke.inputs["Density"])
        smoke.inputs["Density Attribute"].default_value = ""
    link(tree, smoke.outputs[0], tree.nodes["Output"].inputs["Volume"])
    return material


def simplified(scene, folder):
    """Simplify, with something of all that it acts on."""
    volumes(scene, folder)
    skin = add_mesh(scene, "Skin", material=_white())
    skin.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = skin.particle_systems[0].settings
    settings.type, settings.count, settings.child_type, settings.rendered_child_count = "HAIR", 10, "SIMPLE", 4
    cube = add_mesh(scene, "Cube", *CUBE, material=textured(scene, folder))
    cube.modifiers.new("Smooth", "SUBSURF").render_levels = 2
    render = scene.render
    render.use_simplify, render.simplify_subdivision_render = True, 1
    scene.cycles.use_camera_cull = scene.cycles.use_distance_cull = True
    scene.cycles.distance_cull_margin = 4.0
    add_mesh(scene, "Beside", material=_white(), location=(3.2, 0.0, 0.0)).cycles.use_camera_cull = True
    add_mesh(scene, "Below", material=_white(), location=(0.0, 0.0, -8.0)).cycles.use_distance_cull = True


def diced(scene, folder):
    """A cube divided as it is seen, and displaced."""
    material = _displaced()
    cube = add_mesh(scene, "Cube", *CUBE, material=material, location=(0.0, 0.0, 0.0))
    modifier = cube.modifiers.new("Smooth", "SUBSURF")
    owner = modifier if hasattr(modifier, "use_adaptive_subdivision") else cube.cycles
    owner.use_adaptive_subdivision = True
    add_mesh(scene, "Beside", *CUBE, material=material, location=(6.0, 0.0, 0.0))
    other = bpy.data.objects.new("Another camera", bpy.data.cameras.new("Another"))
    other.location = (3.0, 0.0, 9.0)
    scene.collection.objects.link(other)
    scene.cycles.dicing_camera = None
    _floor(scene)
    add_light(scene, "AREA", energy=100.0)


def _displaced():
    material = _white("Displaced")
    tree = material.node_tree
    noise = add_node(tree, "ShaderNodeTexNoise", Scale=4.0)
    moved = add_node(tree, "ShaderNodeDisplacement", Height=noise.outputs[0], Scale=0.2)
    link(tree, moved.outputs[0], tree.nodes["Output"].inputs["Displacement"])
    material.displacement_method = "BOTH"
    return material


def textured(scene, folder):
    """A material of an image on disk, with a bump and holes."""
    material = new_material("Textured")
    tree = material.node_tree
    random = np.random.default_rng(2).random((256, 256, 4))
    image = new_image("Picture", random)
    save_png(image, folder / "picture.png")
    image.source = "FILE"
    texture = add_node(tree, "ShaderNodeTexImage", image=image)
    bump = add_node(tree, "ShaderNodeBump", Height=texture.outputs["Color"])
    principled = add_node(
        tree, "ShaderNodeBsdfPrincipled", Base_Color=texture.outputs["Color"], Alpha=texture.outputs["Alpha"]
    )
    link(tree, bump.outputs[0], principled.inputs["Normal"])
    link(tree, principled.outputs[0], tree.nodes["Output"].inputs["Surface"])
    return material


def materials(scene, folder):
    """Materials with textures, holes, glass, glow and displacement; one catches shadows, one is a hole."""
    floor = _floor(scene, textured(scene, folder))
    cube = add_mesh(scene, "Cube", *CUBE, material=_displaced(), location=(0.8, 0.0, 0.0))
    for polygon in cube.data.polygons:
        polygon.use_smooth = True
    glass, _ = surface("ShaderNodeBsdfGlass", material=new_material("Glass"), Roughness=0.0)
    add_mesh(scene, "Glass", *CUBE, material=glass, location=(-0.8, 0.0, 0.0)).rotation_euler = (0.3, 0.4, 0.5)
    glow, _ = surface("ShaderNodeEmission", material=new_material("Glow"), Strength=3.0)
    add_mesh(scene, "Glow", material=glow, location=(0.0, 2.0, 1.0), scale=(0.3, 0.3, 0.3))
    clear, _ = surface("ShaderNodeBsdfTransparent", material=new_material("Clear"), Color=(0.9, 0.5, 0.5, 1.0))
    add_mesh(scene, "Clear", material=clear, location=(0.3, -0.6, 1.0), scale=(0.4, 0.4, 0.4))
    for name, place in (("is_shadow_catcher", (-1.5, 1.5, 0.0)), ("is_holdout", (1.5, 1.5, 0.0))):
        made = add_mesh(scene, name, material=_white(), location=place, scale=(0.3, 0.3, 0.3))
        setattr(made, name, True)
    inside = collect(scene, floor)
    scene.collection.children.link(inside)
    add_light(scene, "POINT", energy=100.0).data.shadow_soft_size = 0.0
    _world_of_colors(scene)
    scene.render.film_transparent = True
    scene.view_layers[0].use_pass_z = True


def multiplied(scene, folder):
    """Objects multiplied by collections, faces, vertices and particles, and another scene that may be its set."""
    add_mesh(bpy.data.scenes.new("Set"), "Far", *CUBE, material=_white(), location=(0.0, 2.0, 0.0))
    _floor(scene)
    small = add_mesh(scene, "Small", *CUBE, material=_white(), scale=(0.3, 0.3, 0.3))
    lamp = add_light(scene, "POINT", energy=10.0)
    held = collect(scene, small, lamp, name="Held")
    show_collection(scene, held, "Shown", location=(1.0, 1.0, 0.5))
    for kind in ("VERTS", "FACES"):
        owner = add_mesh(scene, kind.title(), location=(-1.0, 0.0, 0.5 if kind == "VERTS" else 0.0))
        owner.instance_type = kind
        child = add_mesh(scene, f"{kind} child", *CUBE, material=_white(), scale=(0.1, 0.1, 0.1))
        child.parent = owner
    thrown = add_mesh(scene, "Thrown", location=(0.0, -1.0, 0.0))
    thrown.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = thrown.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 6, 1, 1, 100
    settings.physics_type, settings.render_type, settings.instance_object = "NO", "OBJECT", small
    settings.particle_size = 0.4
    add_light(scene, "AREA", energy=100.0)
    _world_of_colors(scene)


def layers(scene, folder):
    """View layers with samples of their own, masks and overrides, which are denoised; there is another world."""
    lens(scene, folder)
    own = scene.world
    set_world(scene, (1.0, 0.0, 0.0))
    scene.world = own
    scene.rppm.use_denoising = True
    layer = scene.view_layers[0]
    layer.samples = 3
    scene.cycles.samples = scene.rppm.samples = 2
    masked = bpy.data.collections.new("Masked")
    scene.collection.children.link(masked)
    masked.objects.link(add_mesh(scene, "Held", material=_white("Held"), location=(0.5, 0.5, 0.5), scale=(0.3,) * 3))
    stand = add_object(scene, "Stand", bpy.data.curves.new("Text", "FONT"))
    stand.data.body = "x"


STAGES = {
    stage.__name__: stage
    for stage in (
        lamps, lens, orthographic, panoramas, equirectangular, cylinder, eyes, panoramic_eyes, moving, strands, volumes,
        simplified, diced, materials, multiplied, layers,
    )
}  # fmt: skip
"""Stages by their names."""
