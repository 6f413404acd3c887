# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume nodes and settings that the gallery's scenes with volumes share."""

import bpy


def scattering(name, color, density, anisotropy=0.0):
    """A medium that scatters, of so many collisions a meter."""
    made = bpy.data.materials.new(name)
    tree = made.node_tree
    tree.nodes.clear()
    output, volume = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeVolumeScatter")
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


def set_volume_bounces(scene, rppm, cycles):
    """Volume Bounces of each engine."""
    scene.rppm.volume_bounces, scene.cycles.volume_bounces = rppm, cycles
