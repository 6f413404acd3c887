# SPDX-License-Identifier: GPL-3.0-or-later
"""Mitsuba 3, vectorized by LLVM where that is at hand, else scalar. Option integrator: path or ptracer."""

import math
import os
import sys
import time

import mitsuba
import numpy as np

from ..description import (
    AreaLight,
    Diffuse,
    Glass,
    Light,
    Material,
    Mesh,
    Mirror,
    Scene,
    SphereLight,
    SunLight,
    frame_of,
)
from ..jobs import DEPTH, Job, Recorder, run_adapter

_PASS_SECONDS = 0.25
"""About how long a pass takes: long enough to fill the vectors, short enough to stop in time."""
_FILTER_DEVIATION = 0.427
"""Pixels; of the Gauss curve nearest to Blackman-Harris with Cycles' width of 1.5."""
_SUN_DISTANCE = 5000.0
"""Meters; Mitsuba's only sun has no extent and casts other shadows, so a far disk stands for it."""


def choose_variant() -> str:
    """The faster variant, where LLVM was found beside it or is named: one that is too old ends the process."""
    mitsuba.set_variant("llvm_ad_rgb" if "DRJIT_LIBLLVM_PATH" in os.environ else "scalar_rgb")
    return mitsuba.variant()


def render(job: Job, scene: Scene, recorder: Recorder) -> None:
    made = mitsuba.load_dict(_scene(scene, job))
    _pass(made, 1, 0)
    recorder.first_picture()
    samples = 4
    while True:  # a pass of each size compiles once; the clock runs after that
        _pass(made, samples, 1)
        start = time.perf_counter()
        _pass(made, samples, 2)
        seconds = time.perf_counter() - start
        if seconds > 0.5 * _PASS_SECONDS or samples >= 64:
            break
        samples *= 2
    del made
    start = time.perf_counter()
    made = mitsuba.load_dict(_scene(scene, job))
    total, passes, pending = 0.0, 0, list(job.seconds)
    while pending:
        total = total + _pass(made, samples, (job.seed << 20) + 16 + passes).astype(np.float64)
        passes += 1
        elapsed = time.perf_counter() - start
        while pending and elapsed >= pending[0]:
            recorder.keep(pending.pop(0), elapsed, passes * samples, total / passes)


def _pass(made, samples: int, seed: int) -> np.ndarray:
    return np.array(mitsuba.render(made, spp=samples, seed=seed))


def _scene(scene: Scene, job: Job) -> dict[str, object]:
    made: dict[str, object] = {
        "type": "scene",
        "integrator": {"type": str(job.options["integrator"]), "max_depth": DEPTH, "rr_depth": 8},
        "sensor": _sensor(scene, job.resolution),
    }
    for index, mesh in enumerate(scene.meshes):
        made[f"mesh{index}"] = _mesh(f"mesh{index}", mesh)
    for index, light in enumerate(scene.lights):
        made[f"light{index}"] = _light(light)
    if scene.world > 0.0:
        made["world"] = {"type": "constant", "radiance": _color((scene.world,) * 3)}
    return made


def _sensor(scene: Scene, resolution: int) -> dict[str, object]:
    camera, transform = scene.camera, mitsuba.ScalarTransform4f()
    return {
        "type": "perspective",
        "fov": math.degrees(camera.angle),
        "near_clip": 0.01,
        "to_world": transform.look_at(list(camera.position), list(camera.target), [0.0, 0.0, 1.0]),
        "sampler": {"type": "independent"},
        "film": {
            "type": "hdrfilm",
            "width": resolution,
            "height": resolution,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "gaussian", "stddev": _FILTER_DEVIATION},
        },
    }


def _color(value: tuple[float, float, float]) -> dict[str, object]:
    return {"type": "rgb", "value": list(value)}


def _material(material: Material) -> dict[str, object]:
    match material:
        case Diffuse(color):
            return {"type": "twosided", "inner": {"type": "diffuse", "reflectance": _color(color)}}
        case Mirror(color):
            inner = {"type": "conductor", "material": "none", "specular_reflectance": _color(color)}
            return {"type": "twosided", "inner": inner}
        case Glass(ior):
            return {"type": "dielectric", "int_ior": ior, "ext_ior": 1.0}


def _mesh(name: str, mesh: Mesh):
    properties = mitsuba.Properties()
    properties["bsdf"] = mitsuba.load_dict(_material(mesh.material))
    smooth = mesh.normals is not None
    if not smooth:
        properties["face_normals"] = True
    made = mitsuba.Mesh(name, len(mesh.vertices), len(mesh.triangles), props=properties, has_vertex_normals=smooth)
    parameters = mitsuba.traverse(made)
    parameters["vertex_positions"] = np.ravel(mesh.vertices).astype(np.float32)
    parameters["faces"] = np.ravel(mesh.triangles).astype(np.uint32)
    if smooth:
        parameters["vertex_normals"] = np.ravel(mesh.normals).astype(np.float32)
    parameters.update()
    return made


def _light(light: Light) -> dict[str, object]:
    transform = mitsuba.ScalarTransform4f()
    radiance = _color(tuple(light.radiance * value for value in light.color))
    emitter = {"type": "area", "radiance": radiance}
    match light:
        case SphereLight():
            return {"type": "sphere", "center": list(light.position), "radius": light.radius, "emitter": emitter}
        case AreaLight():
            place = _placed(light.direction, light.position, 0.5 * light.size)
            return {"type": "rectangle", "to_world": transform @ place, "emitter": emitter}
        case SunLight():
            position = tuple(-_SUN_DISTANCE * np.array(light.direction))
            radius = _SUN_DISTANCE * math.tan(0.5 * light.angle)
            place = _placed(light.direction, position, radius)
            return {"type": "disk", "to_world": transform @ place, "emitter": emitter}
    raise ValueError(f"Mitsuba has no light of the kind {type(light).__name__}")


def _placed(direction: tuple, position: tuple, scale: float):
    """The transform that takes +Z to the direction."""
    matrix = np.eye(4)
    matrix[:3, :3] = scale * np.stack(frame_of(direction), axis=1)
    matrix[:3, 3] = position
    return mitsuba.ScalarTransform4f(matrix)


if __name__ == "__main__":
    variant = choose_variant()
    sys.exit(run_adapter(lambda: f"Mitsuba {mitsuba.__version__}, {variant}", render))
