# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume objects: grids of OpenVDB files, of geometry nodes and of fluid domains."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_mesh, add_object, export
from domains_of_gas import domain_of_gas
from node_trees import add_node, link, multiply_cubes, new_material, node_group
from support.media.vdb_files import write_vdb

from rppm_addon.blender.export.geometry.volumes import gas_domains, vdb_files
from rppm_addon.materials.nodes import volumes as volume_nodes
from rppm_addon.scene.node_graphs import Link

MATRIX = np.array([[0.1, 0, 0, 1.0], [0, 0.2, 0, 2.0], [0, 0, 0.1, 3.0], [0, 0, 0, 1]])
COUNTS = (5, 4, 6)


def values(channels=()):
    return np.random.default_rng(1).random((*COUNTS, *channels)).astype(np.float32) + 0.1


def volume_of(scene, path, name="Cloud", material=None):
    volume = bpy.data.volumes.new(name)
    volume.filepath = str(path)
    if material is not None:
        volume.materials.append(material)
    return add_object(scene, name, volume)


def smoke_material(surface=True, density=1.0):
    material = new_material("Smoke")
    tree = material.node_tree
    principled = add_node(tree, "ShaderNodeVolumePrincipled", Density=density)
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    link(tree, principled.outputs[0], output.inputs["Volume"])
    if surface:
        link(tree, add_node(tree, "ShaderNodeEmission").outputs[0], output.inputs["Surface"])
    return material


def test_a_file_becomes_a_box_of_voxels(scene, tmp_path):
    density, color = values(), values((3,))
    volume_of(scene, write_vdb(tmp_path / "cloud.vdb", MATRIX, density=density, color=color))
    exported = export(scene)
    assert exported.warnings == []
    (instance,) = exported.instances
    mesh = exported.meshes[instance.mesh]
    assert mesh.volume.grids.keys() == {"density", "color"}
    grid = mesh.volume.grids["density"]
    np.testing.assert_array_equal(grid.values[1:-1, 1:-1, 1:-1, 0], density)
    assert grid.values.shape == (*(count + 2 for count in COUNTS), 1)
    assert not grid.values[0].any() and not grid.values[:, :, -1].any()
    np.testing.assert_allclose(grid.matrix @ [1, 1, 1, 1], MATRIX @ [0, 0, 0, 1], atol=1e-7)
    np.testing.assert_allclose(grid.matrix[:3, :3], MATRIX[:3, :3], atol=1e-7)
    np.testing.assert_array_equal(mesh.volume.grids["color"].values[1:-1, 1:-1, 1:-1], color)
    low, high = ((MATRIX @ [*corner, 1])[:3] for corner in ((-1, -1, -1), COUNTS))
    np.testing.assert_allclose(mesh.positions.min(axis=0), low, rtol=1e-6)
    np.testing.assert_allclose(mesh.positions.max(axis=0), high, rtol=1e-6)
    first, second, third = np.moveaxis(mesh.positions[mesh.corner_vertices[mesh.triangle_corners]], 1, 0)
    outward = first - mesh.positions.mean(axis=0)
    assert mesh.triangle_count == 12 and ((np.cross(second - first, third - first) * outward).sum(axis=1) > 0.0).all()


def test_a_volume_has_no_surface(scene, tmp_path):
    """A material of its own stands for one that has a surface on other objects."""
    path = write_vdb(tmp_path / "cloud.vdb", MATRIX, density=values())
    volume_of(scene, path, material=smoke_material())
    exported = export(scene)
    (material,) = (exported.materials[number] for number in exported.instances[0].materials)
    assert [node.kind for node in material.graph.nodes] == ["volume_boundary"]
    assert material.interior is not None


def test_a_volume_without_a_material_has_principled_volume(scene, tmp_path):
    """Cycles gives it one; a domain of gas without a material shows nothing."""
    path = write_vdb(tmp_path / "cloud.vdb", MATRIX, density=values())
    volume_of(scene, path, "With", material=smoke_material(surface=False))
    volume_of(scene, path, "Without")
    exported = export(scene)
    inputs = {}
    for instance in exported.instances:
        (number,) = instance.materials
        graph = exported.materials[number].interior
        node, density = (graph.nodes[link.node] for link in (graph.surface, graph.nodes[-1].inputs["density_grid"]))
        assert (node.kind, density.kind, density.attribute) == ("volume_principled", "grid_attribute", "density")
        defaults = {name: default for name, (_, default) in volume_nodes.KINDS[node.kind].inputs.items()}
        inputs[instance.object_name] = {
            name: np.broadcast_to(value, 3).tolist()
            for name, value in (defaults | node.inputs).items()
            if not isinstance(value, Link)
        }
    assert inputs["With"] == inputs["Without"]


@pytest.mark.parametrize("damage", ["missing", "cut", "no volume"])
def test_a_file_that_cannot_be_read_is_named(scene, tmp_path, damage):
    path = write_vdb(tmp_path / "cloud.vdb", MATRIX, density=np.random.default_rng(1).random((40, 40, 40)))
    if damage == "missing":
        path.unlink()
    elif damage == "cut":
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    else:
        path.write_bytes(b"not a volume at all")
    volume_of(scene, path)
    exported = export(scene)
    assert exported.instances == []
    (warning,) = exported.warnings
    assert 'Object "Cloud"' in warning and "cloud.vdb" in warning and "choose another file" in warning


def test_a_volume_without_a_file_shows_nothing(scene):
    add_object(scene, "Empty", bpy.data.volumes.new("Empty"))
    exported = export(scene)
    assert exported.instances == [] and exported.warnings == []


def test_large_grids_are_read_coarser(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(vdb_files, "MAX_VOXELS", 8)
    volume_of(scene, write_vdb(tmp_path / "cloud.vdb", np.eye(4), density=np.ones((4, 4, 4))))
    exported = export(scene)
    (warning,) = exported.warnings
    assert "8 are rendered as one" in warning
    grid = exported.meshes[exported.instances[0].mesh].volume.grids["density"]
    assert grid.values.shape == (4, 4, 4, 1) and grid.values.sum() == 8
    np.testing.assert_allclose(grid.matrix @ [1, 1, 1, 1], [0.5, 0.5, 0.5, 1])


def test_nodes_of_geometry_make_a_volume(scene):
    tree, _, last = node_group(outputs=[("Geometry", "Geometry")], tree_type="GeometryNodeTree")
    link(tree, add_node(tree, "GeometryNodeVolumeCube", Density=0.5).outputs[0], last.inputs[0])
    add_mesh(scene, "Cloud").modifiers.new("Cloud", "NODES").node_group = tree
    exported = export(scene)
    assert exported.warnings == []
    (instance,) = exported.instances
    np.testing.assert_allclose(exported.meshes[instance.mesh].volume.grids["density"].values.max(), 0.5)


def test_a_domain_of_gas_that_is_not_baked_shows_nothing(scene):
    bpy.ops.mesh.primitive_cube_add()
    modifier = bpy.context.object.modifiers.new("Fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    modifier.domain_settings.domain_type = "GAS"
    exported = export(scene)
    assert exported.instances == [] and exported.warnings == []


def test_grids_of_a_domain_of_gas_fill_its_texture_space():
    """Noise makes them finer than the simulation; voxels come with x first."""
    density = np.random.default_rng(1).random((6, 4, 8)).astype(np.float32)
    (grid,) = gas_domains.read_gas(domain_of_gas(density_grid=density.transpose(2, 1, 0).ravel())).values()
    np.testing.assert_array_equal(grid.values[1:-1, 1:-1, 1:-1, 0], density)
    np.testing.assert_allclose(grid.matrix @ [1, 1, 1, 1], [-1.5, -1.5, -3.5, 1.0])
    np.testing.assert_allclose(grid.matrix @ [6, 4, 8, 1], [3.5, 1.5, 3.5, 1.0])


@pytest.mark.parametrize(("space", "thickness"), [("WORLD", 0.5), ("OBJECT", 0.5 / np.sqrt(200.25 / 3.0))])
def test_an_even_cloud(renderer, lit, tmp_path, space, thickness):
    """A cube of voxels before a quad, which a lamp above lights; densities are by length in the world or the object."""
    matrix = np.diag([0.1, 0.1, 0.1, 1.0])
    matrix[:3, 3] = -0.95
    path = write_vdb(tmp_path / "cloud.vdb", matrix, density=np.ones((20, 20, 20)))
    material = smoke_material(surface=False, density=0.5)
    before = renderer.render(export(lit)).frame.combined[12:20, 12:20, :3]
    principled = next(node for node in material.node_tree.nodes if node.type == "PRINCIPLED_VOLUME")
    principled.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    cloud = volume_of(lit, path, material=material)
    cloud.scale = (10.0, 10.0, 0.5)
    cloud.location = (0.0, 0.0, 1.0)
    cloud.data.render.space = space
    scene = export(lit)
    assert scene.warnings == []
    seen = renderer.render(scene).frame.combined[12:20, 12:20, :3]
    np.testing.assert_allclose(seen / before, np.exp(-2.0 * thickness), rtol=2e-2)


def test_a_view_layer_may_have_no_volumes(scene, tmp_path):
    """As in Cycles, fog in meshes stays."""
    volume_of(scene, write_vdb(tmp_path / "cloud.vdb", MATRIX, density=values()))
    add_mesh(scene, "Quad", material=smoke_material())
    assert len(export(scene).instances) == 2
    scene.view_layers[0].use_volumes = False
    (instance,) = export(scene).instances
    assert instance.object_name == "Quad"


@pytest.mark.parametrize("use_volumes", [True, False])
def test_a_domain_of_gas_may_multiply_meshes(scene, use_volumes):
    """They are no gas, whatever the view layer has."""
    host = add_mesh(scene, "Host")
    multiply_cubes(host, [((0.0, 0.0, 1.0), 0.1), ((0.0, 0.0, 2.0), 0.2)])
    domain = host.modifiers.new("Smoke", "FLUID")
    domain.fluid_type, domain.show_viewport, domain.show_render = "DOMAIN", False, False
    domain.domain_settings.domain_type = "GAS"
    scene.view_layers[0].use_volumes = use_volumes
    assert len(export(scene).instances) == 2
