# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume nodes and settings that the gallery's scenes with volumes share."""

import bpy


def scattering(name, color, density, anisotropy=0.0, surface=None):
    """A medium that scatters, of so many collisions a meter; surface: the material it is behind, or none."""
    made = surface or bpy.data.materials.new(name)
    tree = made.node_tree
    if surface is None:
        tree.nodes.clear()
        tree.nodes.new("ShaderNodeOutputMaterial")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    volume = tree.nodes.new("ShaderNodeVolumeScatter")
    volume.inputs["Color"].default_value = (*color, 1)
    volume.inputs["Density"].default_value, volume.inputs["Anisotropy"].default_value = density, anisotropy
    tree.links.new(volume.outputs[0], output.inputs["Volume"])
    return made


def absorbing(medium, color, density):
    """Add absorption to a medium that scatters; returns it."""
    tree = medium.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    volume, both = tree.nodes.new("ShaderNodeVolumeAbsorption"), tree.nodes.new("ShaderNodeAddShader")
    volume.inputs["Color"].default_value, volume.inputs["Density"].default_value = (*color, 1), density
    tree.links.new(output.inputs["Volume"].links[0].from_socket, both.inputs[0])
    tree.links.new(volume.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Volume"])
    return medium


def set_volume_bounces(scene, bounces, cycles=None):
    """As many in both engines; cycles: another number for Cycles."""
    scene.rppm.volume_bounces = bounces
    scene.cycles.volume_bounces = bounces if cycles is None else cycles
