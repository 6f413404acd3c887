# SPDX-License-Identifier: GPL-3.0-or-later
"""The last picture of a viewport moved into the next view, and coarse pictures sharpened at the edges of surfaces.

The first look's program rasterizes what a view sees in full resolution. By its depths each pixel finds where the last
picture had the same point of the same object; by its surfaces a coarse picture is enlarged without running over edges.
A picture counts as many samples as it stands for, so that new ones take over by and by and nothing flashes.
"""

from dataclasses import dataclass

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer, sum_by_name
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...scene.scene import Scene
from ...scene.storage.sharing import same_members
from ..common.camera_view import CAMERA_VIEW, camera_view, is_rasterized
from ..common.stage_sizes import StageSizes, film_pixels
from .first_look import FirstLook

Record(
    "ReprojectionParameters",
    new_width="uint",
    new_height="uint",
    exposure="float",
    new_count="float",
    max_history="float",
    max_specular_history="float",
    way_of_origins="vec3",
)

MAX_HISTORY = 8.0
"""Samples that the last picture counts at most."""
_MAX_SPECULAR_HISTORY = 0.5
"""And where surfaces are specular: what these show does not stay in its place as the view moves."""
HISTORY_ENDS = 32
"""Samples of full resolution after which a picture stands for itself."""

_SURFACES = "surfaces of the viewport"
_TEXTURES = ((4, "f2"), (4, "f4"), (2, "f4"))
"""Components and types of what FirstLook.rasterize draws: colors, normals and depths, numbers."""
_DEPTH_BYTES = 4


@dataclass(frozen=True)
class NewPicture:
    """A picture that was just rendered."""

    buffer: moderngl.Buffer
    """vec4 radiance W/(m^2 sr) and alpha."""
    width: int
    height: int
    samples: float
    """Number of samples that the picture counts as."""


class SeenPicture(BufferSet):
    """A view's surfaces, and the picture that was shown of it."""

    remedy = "make the viewport smaller"
    camera = StorageBuffer("camera of a viewport", CAMERA_VIEW, 1, block="Camera")
    picture = StorageBuffer("viewport picture", "vec4", film_pixels, block="Picture")
    """Scene-linear, exposed, premultiplied alpha."""
    counts = StorageBuffer("samples of the viewport picture", "float", film_pixels, block="Counts")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        gl, size = context.moderngl, (sizes.width, sizes.height)
        self.size = size
        self.plain_picture, self.surfaces, self.numbers = (
            self.own(gl.texture(size, components, dtype=dtype), _SURFACES) for components, dtype in _TEXTURES
        )
        for texture in (self.plain_picture, self.surfaces, self.numbers):
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        depth = self.own(gl.depth_texture(size), _SURFACES)
        self.framebuffer = self.own(gl.framebuffer([self.plain_picture, self.surfaces, self.numbers], depth))
        self.scene: Scene | None = None
        """Scene that the picture shows; None if there is no picture."""
        self._seen: Scene | None = None
        """Scene that the surfaces belong to; None if there are none."""
        self.world_offset = np.zeros(3)
        """(3,) meters from where the camera's place is counted (Scene.world_offset)."""

    @classmethod
    def expected_bytes(cls, sizes: object) -> dict[str, int]:
        """BufferSet.expected_bytes, with its textures."""
        assert isinstance(sizes, StageSizes)
        texel = sum(components * int(dtype[-1]) for components, dtype in _TEXTURES) + _DEPTH_BYTES
        return super().expected_bytes(sizes) | {_SURFACES: texel * film_pixels(sizes)}

    @property
    def blocks(self) -> dict[str, Bindable]:
        """BufferSet.blocks, with the textures of the surfaces, for the picture that is composed."""
        return {
            **super().blocks,
            "surfaces": self.surfaces,
            "numbers": self.numbers,
            "plain_picture": self.plain_picture,
        }

    @property
    def last_blocks(self) -> dict[str, Bindable]:
        """Storage blocks and textures for the last picture, which is moved into another view."""
        return {
            "last_surfaces": self.surfaces,
            "last_numbers": self.numbers,
            "LastCamera": self.camera.buffer,
            "LastPicture": self.picture.buffer,
            "LastCounts": self.counts.buffer,
        }

    def draw(self, first_look: FirstLook, scene: Scene) -> None:
        """Have the surfaces of a scene's view, of this size. Raises SceneError for a camera that sees nothing."""
        if self._seen is not None and self._seen.camera is scene.camera and same_places(self._seen, scene):
            return
        self.forget()
        taken = first_look.take(scene)
        self.camera.upload(camera_view(taken.camera, 0, self.size[1], (0.0, 0.0)))
        first_look.rasterize(self.framebuffer, taken, self.camera.buffer)
        self._seen, self.world_offset = scene, taken.world_offset

    def forget(self) -> None:
        """There is no picture any more."""
        self.scene = self._seen = None

    def read(self) -> np.ndarray:
        """(height, width, 4) float32, row 0 at the bottom."""
        width, height = self.size
        return self.picture.read(np.float32, 4 * width * height).reshape(height, width, 4).copy()


def same_places(a: Scene, b: Scene) -> bool:
    """Whether nothing has moved and every surface is the same."""
    return _have_alike(a, b, "meshes", "instances", "materials")


def _have_alike(a: Scene, b: Scene, *names: str) -> bool:
    lists = ((getattr(a, name), getattr(b, name)) for name in names)
    return all(x is y or same_members(x, y) for x, y in lists)


def differ_by_view(a: Scene, b: Scene) -> bool:
    """Whether a picture of one scene is one of the other from elsewhere."""
    settings = (
        *("film_transparent", "film_transparent_glass", "film_transparent_roughness"),
        *("passes", "direct_light", "use_final_gather"),
    )
    return (
        same_places(a, b)
        and _have_alike(a, b, "lights", "images")
        and a.world is b.world
        and a.exposure == b.exposure
        and a.camera.orthographic == b.camera.orthographic
        and all(getattr(a.settings, name) == getattr(b.settings, name) for name in settings)
    )


def can_move(scene: Scene) -> bool:
    """Whether a rasterized view shows what the scene's pictures show."""
    return is_rasterized(scene.camera) and scene.shutter is None


class Reprojection:
    """The last picture, that of the view that is being rendered, and one moved into a view that is yet to be."""

    def __init__(self, context: Context, library: ProgramLibrary, first_look: FirstLook) -> None:
        self._context = context
        self._library = library
        self._compose = library.compute("viewport/reprojection/compose.comp")
        self._first_look = first_look
        self._last: SeenPicture | None = None
        self._next: SeenPicture | None = None
        self._moved: SeenPicture | None = None

    def has_history(self, scene: Scene) -> bool:
        """Whether there is a picture of another view to be moved into a scene's."""
        return self._history(scene) is not None

    def forget_others(self, scene: Scene) -> None:
        """Let go of scenes that differ from this one by more than the view, and of their pictures."""
        for entry in self._entries:
            if entry.scene is not None and not differ_by_view(entry.scene, scene):
                entry.forget()

    def keep(self, scene: Scene, combined: np.ndarray, samples: float) -> None:
        """Remember a picture that was shown of a scene as it is; (height, width, 4), as compose gives them.

        Raises SceneError for a camera that sees nothing, and DeviceError.
        """
        following = self._following(scene)
        following.picture.upload(combined)
        following.counts.upload(np.full(combined.shape[:2], samples, np.float32))
        following.scene = scene

    def compose(self, scene: Scene, new: NewPicture, fade: float) -> np.ndarray:
        """(height, width, 4) float32 scene-linear, exposed, premultiplied alpha, of a scene's view.

        new: of the same view. fade: what the last picture still counts, 0 to 1.
        Raises SceneError for a camera that sees nothing, and DeviceError.
        """
        following = self._following(scene)
        self._run(following, self._history(scene), scene, new, fade)
        following.scene = scene
        return following.read()

    def move(self, scene: Scene) -> np.ndarray | None:
        """The last picture as a scene's view has it, like compose; None where there is none. Raises as compose."""
        last = self._history(scene)
        if last is None:
            return None
        self._moved = self._sized(self._moved, scene)
        self._moved.draw(self._first_look, scene)
        self._run(self._moved, last, scene, None, 1.0)
        return self._moved.read()

    def _run(
        self, seen: SeenPicture, last: SeenPicture | None, scene: Scene, new: NewPicture | None, fade: float
    ) -> None:
        history = 0.0 if last is None else MAX_HISTORY * fade
        last = last or seen  # something has to be bound
        self._compose.run(
            seen.size[0] * seen.size[1],
            {**seen.blocks, **last.last_blocks, "NewPicture": last.picture.buffer if new is None else new.buffer},
            {
                "new_width": 0 if new is None else new.width,
                "new_height": 0 if new is None else new.height,
                "exposure": scene.exposure,
                "new_count": 0.0 if new is None else new.samples,
                "max_history": history,
                "max_specular_history": min(history, _MAX_SPECULAR_HISTORY),
                "way_of_origins": seen.world_offset - last.world_offset,
            },
        )

    def _history(self, scene: Scene) -> SeenPicture | None:
        """The newest picture of another view that can be moved into a scene's."""
        for entry in (self._next, self._last):
            if entry is not None and entry.scene is not None and entry.scene.camera is not scene.camera:
                return entry if can_move(scene) and differ_by_view(entry.scene, scene) else None
        return None

    def _following(self, scene: Scene) -> SeenPicture:
        """Begin the picture of a scene's view, beside the last one of another view."""
        if self._next is not None and self._next.scene is not None and self._next.scene.camera is not scene.camera:
            self._last, self._next = self._next, self._last
        self._next = self._sized(self._next, scene)
        self._next.draw(self._first_look, scene)
        return self._next

    def _sized(self, entry: SeenPicture | None, scene: Scene) -> SeenPicture:
        """An entry of a scene's size, this one if it is."""
        if entry is not None and entry.size == scene.camera.resolution:
            return entry
        if entry is not None:
            entry.release()
        return SeenPicture(self._context, self._library, StageSizes(*scene.camera.resolution))

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes on the device by buffer."""
        return sum_by_name(entry.memory_bytes for entry in self._entries)

    @property
    def _entries(self) -> list[SeenPicture]:
        return [entry for entry in (self._last, self._next, self._moved) if entry is not None]

    def release(self) -> None:
        """Give all of it back."""
        for entry in self._entries:
            entry.release()
        self._last = self._next = self._moved = None
