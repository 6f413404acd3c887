# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays of panoramas and lenses against their formulas, and ray-traced pictures against rasterized ones."""

import numpy as np
import pytest
import scenes
from rendering import iterated
from support.iteration_block import iteration_buffer

from rppm_addon.gl.programs.sources import expand
from rppm_addon.integrator.camera_paths.gbuffer import GBuffer
from rppm_addon.integrator.camera_paths.primary_rays import PrimaryRays, stereo_parameters
from rppm_addon.integrator.common.camera_view import CAMERA_VIEW, camera_view
from rppm_addon.integrator.common.records.camera_paths import CAMERA_PATH
from rppm_addon.integrator.common.records.rays import HIT, NO_TRIANGLE, RAY
from rppm_addon.scene import DirectLight, FirstCameraHits, Light, LightKind
from rppm_addon.scene.camera import Aperture, Camera, Panorama, PanoramaKind, SphericalStereo

WIDTH, HEIGHT = 24, 16
KIND = PanoramaKind


def traced_rays(context, library, camera, iteration=1, seed=0):
    """Rays (H, W) and camera paths (H, W) of the whole region."""
    gl = context.moderngl
    width, height = camera.resolution
    rays, paths = gl.buffer(reserve=RAY.size * width * height), gl.buffer(reserve=CAMERA_PATH.size * width * height)
    blocks = {
        "Camera": gl.buffer(camera_view(camera, 0, height, (0.0, 0.0)).tobytes()), "Rays": rays, "CameraPaths": paths,
        "Iteration": iteration_buffer(context, number=iteration + 1, seed=seed),
    }  # fmt: skip
    defines = {} if camera.stereo is None else {"SPHERICAL_STEREO": 1}
    program = library.compute("camera_paths/primary_rays/rays.comp", defines)
    program.run(width * height, blocks, {"first_pixel": 0, **stereo_parameters(camera)})
    found = [np.frombuffer(buffer.read(), record.dtype) for buffer, record in ((rays, RAY), (paths, CAMERA_PATH))]
    for buffer in blocks.values():
        buffer.release()
    return [records.reshape(height, width) for records in found]


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def off_axis(angle, across):
    """(..., 3) right, up, forward at an angle off the axis toward a point of the frame."""
    toward = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-300)
    return np.concatenate([np.sin(angle)[..., None] * toward, np.cos(angle)[..., None]], axis=-1)


def panorama_direction(panorama, u, v):
    """(..., 3) right, up, forward where a panorama looks at u, v in 0 to 1; NaN where it sees nothing.

    After what Blender's manual says of each kind, in float64.
    """
    kind = panorama.kind
    if kind is KIND.EQUIRECTANGULAR:
        (west, east), (south, north) = panorama.longitude, panorama.latitude
        longitude, latitude = west + (east - west) * u, south + (north - south) * v
        level = np.cos(latitude)
        return np.stack([level * np.sin(longitude), np.sin(latitude), level * np.cos(longitude)], axis=-1)
    if kind is KIND.CENTRAL_CYLINDRICAL:
        (west, east), (low, high) = panorama.longitude, panorama.height
        longitude = west + (east - west) * u
        return unit(np.stack([np.sin(longitude), low + (high - low) * v, np.cos(longitude)], axis=-1))
    if kind is KIND.EQUIANGULAR_CUBEMAP_FACE:
        x, y = np.tan((u - 0.5) * np.pi / 2), np.tan((v - 0.5) * np.pi / 2)
        return unit(np.stack([x, y, np.ones_like(x)], axis=-1))
    across = np.stack([2 * u - 1, 2 * v - 1], axis=-1)
    if kind is KIND.MIRRORBALL:
        # Parallel rays from the viewer reflected by a ball.
        with np.errstate(invalid="ignore"):
            normal = np.concatenate([across, np.sqrt(1 - (across**2).sum(-1, keepdims=True))], axis=-1)
        incoming = np.array([0.0, 0.0, -1.0])
        return incoming - 2 * (normal @ incoming)[..., None] * normal
    if kind is KIND.FISHEYE_EQUIDISTANT:
        radius = np.linalg.norm(across, axis=-1)
        direction = off_axis(0.5 * panorama.field_of_view * radius, across)
        return np.where(radius[..., None] > 1, np.nan, direction)
    across = 0.5 * across * np.array(panorama.sensor)
    radius = np.linalg.norm(across, axis=-1)
    if kind is KIND.FISHEYE_EQUISOLID:
        with np.errstate(invalid="ignore"):
            angle = 2 * np.arcsin(radius / (2 * panorama.lens))
    else:
        angle = -np.polynomial.polynomial.polyval(radius, panorama.polynomial)
    seen = abs(angle) <= 0.5 * panorama.field_of_view
    return np.where(seen[..., None], off_axis(angle, across), np.nan)


PANORAMAS = {
    "equirectangular": Panorama(KIND.EQUIRECTANGULAR),
    "equirectangular_part": Panorama(KIND.EQUIRECTANGULAR, longitude=(-0.5, 2.0), latitude=(0.3, 1.4)),
    "equirectangular_mirrored": Panorama(KIND.EQUIRECTANGULAR, longitude=(1.0, -1.0)),
    "cubemap_face": Panorama(KIND.EQUIANGULAR_CUBEMAP_FACE),
    "mirrorball": Panorama(KIND.MIRRORBALL),
    "equidistant": Panorama(KIND.FISHEYE_EQUIDISTANT, field_of_view=3.5),
    "equidistant_wrapped": Panorama(KIND.FISHEYE_EQUIDISTANT, field_of_view=8.0),
    "equisolid": Panorama(KIND.FISHEYE_EQUISOLID, field_of_view=2.8, lens=10.5, sensor=(36.0, 24.0)),
    "polynomial": Panorama(
        KIND.FISHEYE_LENS_POLYNOMIAL, field_of_view=2.0, sensor=(36.0, 24.0),
        polynomial=(-1e-5, -0.06, -2e-4, 3e-6, -2.6e-8),
    ),
    "cylindrical": Panorama(KIND.CENTRAL_CYLINDRICAL, longitude=(-2.0, 1.5), height=(-0.7, 1.2)),
}  # fmt: skip


def frame_coordinates(window=(0.0, 1.0, 0.0, 1.0), width=WIDTH, height=HEIGHT):
    left, right, bottom, top = window
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    return left + (right - left) * x, bottom + (top - bottom) * y


def world_directions(camera, local):
    """Right, up, forward to world."""
    return local @ (camera.matrix[:3, :3] * (1, 1, -1)).T


@pytest.mark.parametrize("name", PANORAMAS)
@pytest.mark.parametrize("window", [(0.0, 1.0, 0.0, 1.0), (0.1, 1.1, -0.2, 0.8)])
def test_panoramas_look_where_their_formulas_say(context, library, name, window):
    panorama = PANORAMAS[name]
    camera = Camera(scenes.looking((1, 2, 3), (0, 5, 2)), window, WIDTH, HEIGHT, panorama=panorama)
    camera.clip_start, camera.clip_end = 0.25, 40.0
    rays, paths = traced_rays(context, library, camera)
    u, v = frame_coordinates(window)
    local = panorama_direction(panorama, u, v)
    seen = np.isfinite(local).all(-1)
    assert ((rays["maximum_distance"] > 0) == seen).all() and seen.any()
    expected = world_directions(camera, local)[seen]
    # A ten-thousandth of a pixel: at the rim of a mirror ball little of a float's accuracy remains.
    np.testing.assert_allclose(rays["direction"][seen], expected, atol=1e-5)
    np.testing.assert_allclose(rays["origin"][seen], camera.matrix[:3, 3] + 0.25 * expected, atol=1e-5)
    np.testing.assert_allclose(rays["maximum_distance"][seen], 39.75, rtol=1e-6)
    np.testing.assert_allclose(paths["total_length"][seen], 0.25)


@pytest.mark.parametrize("name", PANORAMAS)
def test_footprints_are_the_solid_angles_of_pixels(context, library, name):
    """By differences of the formulas' directions, in float64; sums over whole spheres are 4 pi."""
    panorama = PANORAMAS[name]
    camera = Camera(np.eye(4), (0.0, 1.0, 0.0, 1.0), WIDTH, HEIGHT, panorama=panorama)
    rays, paths = traced_rays(context, library, camera)
    u, v = frame_coordinates()
    step = 1e-5
    sides = [panorama_direction(panorama, u + a, v + b) for a, b in ((-step, 0), (step, 0), (0, -step), (0, step))]
    seen = np.isfinite(sum(sides)).all(-1) & (rays["maximum_distance"] > 0)
    across, upward = (sides[1] - sides[0])[seen] / (2 * step), (sides[3] - sides[2])[seen] / (2 * step)
    expected = np.linalg.norm(np.cross(across, upward), axis=-1) / (WIDTH * HEIGHT)
    got = np.pi * paths["primary_radius"][seen].astype(float) ** 2
    np.testing.assert_allclose(got, expected, rtol=2e-4)
    if name == "equirectangular":
        np.testing.assert_allclose(got.sum(), 4 * np.pi, rtol=5e-3)


def test_a_crop_is_a_part_of_the_frame(context, library):
    camera = Camera(np.eye(4), (0.0, 1.0, 0.0, 1.0), WIDTH, HEIGHT, panorama=PANORAMAS["equidistant"])
    whole, _ = traced_rays(context, library, camera)
    camera.crop = (5, 3, 20, 9)
    part, _ = traced_rays(context, library, camera)
    np.testing.assert_allclose(part["direction"], whole["direction"][3:9, 5:20], atol=1e-6)


FOCUS = 3.0
APERTURES = {
    "disk": Aperture(0.2, FOCUS),
    "two_blades": Aperture(0.2, FOCUS, blades=2),
    "pentagon": Aperture(0.2, FOCUS, blades=5, rotation=0.4),
    "wide_hexagon": Aperture(0.1, FOCUS, blades=6, rotation=-0.3, ratio=0.5),
}


def opening(aperture, points):
    """How far (n, 2) points on the lens lie from its middle: 1 at the rim. After Blender's meaning of its settings."""
    points = points * (aperture.ratio, 1.0) / aperture.radius
    if aperture.blades < 3:
        return np.linalg.norm(points, axis=-1)
    angles = aperture.rotation + 2 * np.pi * np.arange(aperture.blades) / aperture.blades
    middles = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return (points @ middles.T).max(-1) / np.cos(np.pi / aperture.blades)


def lens_points(context, library, camera, count):
    """(count, H, W) origins and directions in the camera's axes (right, up, forward), with the clip start taken off."""
    origins, directions = [], []
    axes = camera.matrix[:3, :3] * (1, 1, -1)
    for iteration in range(1, count + 1):
        rays, paths = traced_rays(context, library, camera, iteration)
        start = rays["origin"] - paths["total_length"][..., None] * rays["direction"].astype(float)
        origins.append((start - camera.matrix[:3, 3]) @ axes)
        directions.append(rays["direction"].astype(float) @ axes)
    return np.array(origins), np.array(directions)


@pytest.mark.parametrize("name", APERTURES)
@pytest.mark.parametrize("orthographic", [False, True])
def test_rays_of_a_lens_meet_in_focus(context, library, name, orthographic):
    aperture = APERTURES[name]
    window = (-0.6, 0.8, -0.5, 0.5)
    camera = Camera(scenes.looking((1, 2, 3), (0, 5, 2)), window, WIDTH, HEIGHT, orthographic, aperture=aperture)
    origins, directions = lens_points(context, library, camera, 64)
    x, y = frame_coordinates(window)
    axis = np.stack([x, y, np.ones_like(x)], axis=-1)
    plane = np.stack([x, y, np.zeros_like(x)], axis=-1) if orthographic else np.zeros_like(axis)
    focus = plane + FOCUS * (np.array([0, 0, 1.0]) if orthographic else axis)
    meeting = origins + directions * (FOCUS / directions[..., 2:])
    np.testing.assert_allclose(meeting, np.broadcast_to(focus, meeting.shape), atol=3e-5)
    lens = (origins - plane)[..., :2]
    np.testing.assert_allclose((origins - plane)[..., 2], 0, atol=1e-5)
    check_distribution(aperture, lens)


def check_distribution(aperture, lens):
    """lens: (samples, H, W, 2): evenly over the opening, each pixel by itself, and no pixel as another."""
    rim = opening(aperture, lens)
    assert rim.max() <= 1 + 1e-4 and rim.max() > 0.99
    shares = rim.reshape(-1) ** 2  # the share of the opening within
    np.testing.assert_allclose(np.histogram(shares, 8, (0, 1 + 1e-3))[0] / shares.size, 1 / 8, atol=3e-3)
    scaled = lens.reshape(-1, 2) * (aperture.ratio, 1.0)
    angle = np.arctan2(scaled[:, 1], scaled[:, 0]) - aperture.rotation
    corners = aperture.blades if aperture.blades >= 3 else 5
    sector = np.floor(angle / (2 * np.pi / corners) + 0.5).astype(int) % corners
    np.testing.assert_allclose(np.bincount(sector) / sector.size, 1 / corners, atol=3e-3)
    # 64 scattered points of one pixel leave a mean of a 16th of the radius; evenly spread ones far less.
    spread = lens.std(axis=(0, 1, 2))
    np.testing.assert_allclose(lens.mean(axis=0).std(axis=(0, 1)) / spread, 0, atol=0.03)
    first = lens[0].reshape(-1, 2)
    assert len(np.unique(first.round(7), axis=0)) > 0.95 * len(first)
    neighbors = (lens[0, :, 1:] * lens[0, :, :-1]).mean() / (lens[0] ** 2).mean()
    assert abs(neighbors) < 0.15


@pytest.mark.parametrize("name", ["equirectangular", "mirrorball", "equidistant"])
def test_the_lens_of_a_panorama_faces_each_direction(context, library, name):
    aperture = APERTURES["pentagon"]
    camera = Camera(scenes.looking((1, 2, 3), (0, 5, 2)), (0.0, 1.0, 0.0, 1.0), WIDTH, HEIGHT, aperture=aperture)
    camera.panorama = PANORAMAS[name]
    origins, directions = lens_points(context, library, camera, 64)
    local = panorama_direction(camera.panorama, *frame_coordinates())
    seen = np.isfinite(local).all(-1)
    local, origins, directions = local[seen], origins[:, seen], directions[:, seen]
    np.testing.assert_allclose((origins * local).sum(-1), 0, atol=1e-5)
    along = ((FOCUS * local - origins) * directions).sum(-1, keepdims=True)
    np.testing.assert_allclose(origins + along * directions, np.broadcast_to(FOCUS * local, origins.shape), atol=3e-5)
    # The lens's width lies in the plane of the direction and the front, or of a mirror ball's right.
    front = np.array([1.0, 0, 0]) if name == "mirrorball" else np.array([0, 0, 1.0])
    width = unit(front - (local @ front)[:, None] * local)
    height = np.cross(width, local) if name != "mirrorball" else np.cross(local, width)
    lens = np.stack([(origins * width).sum(-1), (origins * height).sum(-1)], axis=-1)
    assert opening(aperture, lens).max() <= 1 + 1e-3


def test_clip_distances_follow_the_ray_through_the_lens_center(context, library):
    """As in Cycles: in perspective they are stretched as that ray is, in panoramas they lie along the ray."""
    window = (-1.0, 1.0, -1.0, 1.0)
    camera = Camera(np.eye(4), window, WIDTH, HEIGHT, clip_start=0.5, clip_end=4.5, aperture=APERTURES["disk"])
    rays, paths = traced_rays(context, library, camera)
    x, y = frame_coordinates(window)
    stretch = np.sqrt(1 + x**2 + y**2)
    np.testing.assert_allclose(paths["total_length"], 0.5 * stretch, rtol=1e-6)
    np.testing.assert_allclose(rays["maximum_distance"], 4.0 * stretch, rtol=1e-6)
    camera.orthographic = True
    rays, paths = traced_rays(context, library, camera)
    np.testing.assert_allclose(rays["origin"][..., 2], -0.5, rtol=1e-6)
    np.testing.assert_allclose(rays["maximum_distance"], 4.0, rtol=1e-6)


SETTINGS = {
    "gathering": {},
    "photons_only": {"direct_light": DirectLight.PHOTONS, "use_final_gather": False},
    "direct_light_by_photons": {"direct_light": DirectLight.PHOTONS},
}


@pytest.mark.parametrize("name", SETTINGS)
@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize("has_lens", [False, True])
def test_traced_hits_give_the_raster_picture(renderer, name, orthographic, has_lens):
    """Traced first hits against rasterized ones, with photons on the camera's view; through a lens of no size,
    photons are found by the cubemap.

    In the first iteration both have the same photons; later ones go where these were of use, to the last pixel.
    """
    scene = scenes.room(24, photons=16384, iterations=1, first_camera_hits=FirstCameraHits.RASTERIZED, **SETTINGS[name])
    if orthographic:
        scene.camera.orthographic, scene.camera.window = True, (-1.0, 1.0, -1.0, 1.0)
    raster = renderer.render(scene).frame
    scene.settings.first_camera_hits = FirstCameraHits.TRACED
    scene.camera.aperture = Aperture(0.0, 3.0) if has_lens else None
    traced = renderer.render(scene).frame
    # Pixels whose middle lies on an edge may see either side of it.
    same = np.isclose(traced.combined, raster.combined, rtol=2e-3, atol=2e-3).all(-1)
    assert same.mean() > 0.97
    np.testing.assert_allclose(traced.combined.mean((0, 1)), raster.combined.mean((0, 1)), rtol=5e-3)
    np.testing.assert_allclose(traced.passes["Depth"][same], raster.passes["Depth"][same], rtol=1e-3)
    assert np.isclose(traced.passes["Normal"], raster.passes["Normal"], atol=2e-3).all(-1).mean() > 0.97


def ball_room(camera, **settings):
    """The camera in the middle of a ball of radius 2."""
    light = Light("light", LightKind.POINT, scenes.placed(0.3, 0.2, 0.1), np.ones(3))
    ball = scenes.sphere("ball"), scenes.diffuse(0.5, 0.5, 0.5)
    scene = scenes.scene_of(camera, ball, lights=[light], photons=64, filter_width=0.0, **settings)
    scene.instances[0].matrix = scenes.placed(0, 0, 0, 2.0)
    return scene


def test_depth_of_a_panorama_is_the_distance(renderer):
    camera = Camera(scenes.looking((0, 0, 0), (1, 0, 0)), (0.0, 1.0, 0.0, 1.0), WIDTH, HEIGHT)
    camera.panorama = PANORAMAS["equirectangular"]
    frame = renderer.render(ball_room(camera, iterations=1)).frame
    assert (frame.passes["Depth"] <= 2.0 + 1e-5).all() and (frame.passes["Depth"] > 1.9).all()
    directions = world_directions(camera, panorama_direction(camera.panorama, *frame_coordinates()))
    assert ((frame.passes["Normal"] * directions).sum(-1) < -0.95).all()


def test_outside_of_a_fisheye_is_black(renderer):
    camera = Camera(scenes.looking((0, 0, 0), (1, 0, 0)), (0.0, 1.0, 0.0, 1.0), 16, 16)
    camera.panorama = Panorama(KIND.FISHEYE_EQUIDISTANT)
    frame = renderer.render(ball_room(camera, iterations=2)).frame
    x, y = frame_coordinates(width=16, height=16)
    outside = np.hypot(2 * x - 1, 2 * y - 1) > 1
    assert outside.any() and (frame.combined[outside, :3] == 0).all() and (frame.passes["Depth"][outside] == 1e10).all()
    assert (frame.passes["Depth"][~outside] < 3).all() and (frame.passes["Normal"][outside] == 0).all()


def test_records_agree_with_the_shader():
    source = expand("camera_paths/gbuffer/projections.glsl").text
    for index, kind in enumerate(PanoramaKind):
        assert f"PROJECTION_{kind.name} = {index + 2}u" in source
    assert CAMERA_VIEW.size % 16 == 0


@pytest.mark.parametrize(("asked", "rasterizes"), [
    (FirstCameraHits.RASTERIZED, True), (FirstCameraHits.TRACED, False), (FirstCameraHits.AUTOMATIC, False)
])  # fmt: skip
def test_software_drivers_trace_first_hits(mapper, asked, rasterizes):
    if not mapper.context.is_software and asked is FirstCameraHits.AUTOMATIC:
        rasterizes = True
    mapper.build(scenes.room(16, first_camera_hits=asked))
    assert isinstance(mapper.stages.camera_hits, GBuffer if rasterizes else PrimaryRays)


def test_what_is_drawn_is_what_is_traced(mapper):
    """In a scene with all kinds of surfaces, hits are the same bit for bit, but for edges."""
    hits = {}
    for route in (FirstCameraHits.RASTERIZED, FirstCameraHits.TRACED):
        iterated(mapper, scenes.crowded_room(48, first_camera_hits=route, camera_path_length=1))
        hits[route] = mapper.stages.importons.hits.read(HIT.dtype, 48 * 48)
    drawn, traced = hits.values()
    same = drawn["triangle"] == traced["triangle"]
    assert same.mean() > 0.995
    seen = same & (traced["triangle"] != NO_TRIANGLE)
    np.testing.assert_array_equal(drawn[seen], traced[seen])
    assert seen.mean() > 0.5


@pytest.mark.parametrize("distance", [None, 2.5])
def test_eyes_stand_beside_the_directions_in_which_they_look(context, library, distance):
    """They meet at the convergence distance, and at the poles where they are merged."""
    panorama = Panorama(KIND.EQUIRECTANGULAR)
    matrix = scenes.looking((0.3, 0.2, 0.1), (1.0, 2.0, 0.7))
    lenses = (None, *(SphericalStereo(0.1 * side, distance, (0.5, 1.2)) for side in (-1.0, 1.0)))
    middle, left, right = (
        traced_rays(
            context,
            library,
            Camera(matrix, (0.0, 1.0, 0.0, 1.0), WIDTH, HEIGHT, clip_start=0.0, panorama=panorama, stereo=stereo),
        )[0]
        for stereo in lenses
    )
    directions = middle["direction"].astype(np.float64)
    altitudes = np.abs(np.arcsin((directions @ matrix[:3, 1]).clip(-1.0, 1.0)))
    factors = np.where(altitudes < 0.5, 1.0, np.cos(0.5 * np.pi * (altitudes - 0.5) / 0.7)) * (altitudes < 1.2)
    for eye, side in ((left, -1.0), (right, 1.0)):
        beside = unit(np.cross(directions, matrix[:3, 1]))
        offsets = 0.1 * side * factors[..., None] * beside
        np.testing.assert_allclose(
            eye["origin"] - middle["origin"], offsets, atol=2e-4
        )  # as near as drivers come to asin
        expected = directions if distance is None else unit(distance * directions - offsets)
        np.testing.assert_allclose(eye["direction"], expected, atol=2e-4)
