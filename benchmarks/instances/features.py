# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures a forest of instances with features that once had all instances expanded.

    python -m benchmarks.instances.features                                  # 300 trees of 5,000 triangles
    python -m benchmarks.instances.features --trees 1000000 --ways TWO_LEVELS --names vector

Prints a table: each feature with Instances set to Expanded and to Two Levels, in processes of their own. Seconds are
of the processor, all threads together. Needs no Blender.
"""

import argparse
import dataclasses
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable

import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import (
    AccelerationStructure,
    Camera,
    Instance,
    Instancing,
    Light,
    LightKind,
    Link,
    Material,
    Mesh,
    NodeGraph,
    RenderSettings,
    Scene,
    Texels,
    World,
)
from rppm_addon.scene.motion import Deformation, Movement, Shutter
from rppm_addon.self_test.meshes import looking, rectangle

from .. import ROOT

_SIZE = 160, 100
_SAMPLES = 3
_DISTANCE = 3.0
"""Meters from tree to tree."""
TREE, GROUND = 0, 1


def colored(color: object, graph: NodeGraph | None = None) -> Material:
    """A diffuse material of a color, or of what a node of the graph gives."""
    graph = graph or NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=color)
    return Material("colored", graph)


def by_node(kind: str, output: str, **inputs: object) -> Material:
    """A diffuse material whose color a node gives."""
    graph = NodeGraph()
    return colored(graph.add(kind, output, **inputs), graph)


def tree(triangles: int) -> Mesh:
    """A crown: so many small triangles in a cloud above the ground."""
    random = np.random.default_rng(0)
    centers = random.normal(size=(triangles, 1, 3)) * [0.5, 0.5, 1.0] + [0.0, 0.0, 2.0]
    corners = (centers + random.normal(size=(triangles, 3, 3)) * 0.03).astype(np.float32).reshape(-1, 3)
    numbers = np.arange(len(corners), dtype=np.int32)
    return Mesh("tree", corners, numbers, np.zeros_like(corners), numbers.reshape(-1, 3), np.zeros(triangles, np.int32))


def forest(count: int, triangles: int) -> Scene:
    """So many trees of so many triangles, turned and scaled, on a ground."""
    random = np.random.default_rng(1)
    side = int(np.ceil(np.sqrt(count)))
    half = 0.5 * _DISTANCE * side
    angles, scales = random.uniform(0.0, 2.0 * np.pi, count), random.uniform(0.7, 1.3, count)
    matrices = np.tile(np.eye(4), (count, 1, 1))
    matrices[:, 0, 0] = matrices[:, 1, 1] = scales * np.cos(angles)
    matrices[:, 1, 0], matrices[:, 0, 1] = scales * np.sin(angles), -scales * np.sin(angles)
    matrices[:, 2, 2] = scales
    places = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
    matrices[:, :2, 3] = _DISTANCE * places - half + random.uniform(-1.0, 1.0, (count, 2))
    ground = rectangle("ground", (-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0))
    return Scene(
        Camera(looking((0, -0.3 * half, 6), (0, 0, 2)), (-0.6, 0.6, -0.4, 0.4), *_SIZE),
        [tree(triangles), ground],
        [*(Instance(TREE, matrix, [0], "tree") for matrix in matrices), Instance(GROUND, np.eye(4), [1], "ground")],
        [colored((0.1, 0.5, 0.1)), colored((0.4, 0.3, 0.2))],
        [Light("sun", LightKind.SUN, looking((0, -3, 4), (0, 0, 0)), np.full(3, 2.0))],
        World(np.array([0.3, 0.4, 0.6])),
        settings=RenderSettings(photons=20000),
    )


def with_leaves(make: Callable[[], Material]) -> Callable[[Scene], Scene]:
    """The forest with a material of the trees."""
    return lambda scene: dataclasses.replace(scene, materials=[make(), scene.materials[GROUND]])


def with_settings(**settings: object) -> Callable[[Scene], Scene]:
    return lambda scene: dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, **settings))


def with_vectors(scene: Scene) -> Scene:
    """A tenth of the trees sways from frame to frame."""
    times = np.array([0.0, 0.5, 1.0])
    swaying = []
    for member in range(0, len(scene.instances) - 1, 10):
        matrices = np.stack([scene.instances[member].matrix] * 3)
        matrices[:, 0, 2] += (-0.05, 0.0, 0.05)
        swaying.append(Movement(member, times, matrices))
    settings = dataclasses.replace(scene.settings, passes=("Vector",))
    return dataclasses.replace(scene, neighbors=Shutter(np.ones(1), swaying), settings=settings)


def with_wind(scene: Scene) -> Scene:
    """The tree bends while the shutter is open."""
    mesh = scene.meshes[TREE]
    bent = mesh.positions + np.float32([0.05, 0.0, 0.0]) * mesh.positions[:, 2:]
    deformation = Deformation(
        TREE, np.array([0.0, 1.0]), np.stack([mesh.positions, bent]), np.stack([mesh.corner_normals] * 2)
    )
    return dataclasses.replace(scene, shutter=Shutter(np.ones(4), meshes=[deformation]))


def with_bake(scene: Scene) -> Scene:
    """A texture of the ground."""
    width, height = _SIZE
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    texels = Texels(
        len(scene.instances) - 1,
        np.zeros((height, width), np.int32),
        np.stack([0.5 * x, 0.5 * y], axis=-1).astype(np.float32),
        np.tile(np.float32([0.25 / width, 0.0, 0.0, 0.25 / height]), (height, width, 1)),
    )
    camera = Camera(scene.camera.matrix, (0.0, width, 0.0, height), width, height, orthographic=True, texels=texels)
    return dataclasses.replace(scene, camera=camera)


def with_fog(scene: Scene) -> Scene:
    """Mist around everything, through deep cubemaps."""
    graph = NodeGraph()
    graph.surface = graph.add(
        "volume_coefficients",
        "volume",
        scatter_coefficients=(0.01, 0.01, 0.01),
        absorption_coefficients=(0.0, 0.0, 0.0),
        emission_coefficients=(0.0, 0.0, 0.0),
    )
    world = dataclasses.replace(scene.world, volume=graph)
    through = with_settings(acceleration_structure=AccelerationStructure.DEEP_CUBEMAP)
    return through(dataclasses.replace(scene, world=world))


def raycast() -> Material:
    graph = NodeGraph()
    found = graph.add("raycast", "is_hit", length=5.0)
    return colored(graph.add("combine_xyz", "vector", x=found, y=Link(found.node, "hit_distance"), z=0.1), graph)


FEATURES: dict[str, Callable[[Scene], Scene]] = {
    "none": lambda scene: scene,
    "pass Vector": with_vectors,
    "Ambient Occlusion": with_leaves(lambda: by_node("ambient_occlusion", "color", samples=4.0, distance=0.5)),
    "Bevel": with_leaves(lambda: by_node("bevel", "normal", samples=4.0, radius=0.02)),
    "Raycast": with_leaves(raycast),
    "baking": with_bake,
    "motion blur of a mesh that bends": with_wind,
    "fog, deep cubemap": with_fog,
    "pass Deep Cubemap": with_settings(passes=("Deep Cubemap",)),
}


def measure(name: str, way: str, trees: int, triangles: int) -> dict[str, float]:
    """Megabytes of the device's buffers and of the process, and processor seconds of the build and of a sample."""
    scene = FEATURES[name](with_settings(instancing=Instancing[way])(forest(trees, triangles)))
    context = Context.create()
    mapper = ProgressivePhotonMapper(context, ProgramLibrary(context))
    for _ in range(2):  # the first compiles programs
        began = time.process_time()
        mapper.build(scene)
        context.finish()
        built = time.process_time() - began
        mapper.iterate()
    began = time.process_time()
    for _ in range(_SAMPLES):
        mapper.iterate()
    context.finish()
    return {
        "device": sum(mapper.memory_bytes.values()) / 1e6,
        "process": 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6,
        "build": built,
        "sample": (time.process_time() - began) / _SAMPLES,
    }


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--names", nargs="+", choices=FEATURES, default=list(FEATURES))
    parser.add_argument("--ways", nargs="+", choices=("EXPANDED", "TWO_LEVELS"), default=["EXPANDED", "TWO_LEVELS"])
    parser.add_argument("--trees", type=int, default=300)
    parser.add_argument("--triangles", type=int, default=5000, help="of a tree (5000)")
    parser.add_argument("--one", action="store_true", help="measure the first name and way in this process")
    options = parser.parse_args(arguments)
    if options.one:
        print(json.dumps(measure(options.names[0], options.ways[0], options.trees, options.triangles)), flush=True)
        return 0
    print("| feature | instances | device, MB | process, MB | build, s | sample, s |\n|---|---|--:|--:|--:|--:|")
    for name in options.names:
        for way in options.ways:
            command = [sys.executable, "-m", __spec__.name, "--one", "--names", name, "--ways", way]
            sizes = ["--trees", str(options.trees), "--triangles", str(options.triangles)]
            done = subprocess.run([*command, *sizes], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
            found = json.loads(done.stdout.splitlines()[-1])
            memory = f"{found['device']:.0f} | {found['process']:.0f}"
            print(f"| {name} | {way} | {memory} | {found['build']:.2f} | {found['sample']:.2f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
