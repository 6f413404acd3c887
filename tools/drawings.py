# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the pictures of docs/how_it_works.md and the icon, to docs/images/: ``python tools/drawings.py``.

What is drawn is computed: rays are refracted by Snell's law, and radii shrink by Eq. 2.
"""

import math
import random
from collections.abc import Iterable, Sequence
from pathlib import Path

from PIL import Image, ImageDraw

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
Point = tuple[float, float]
INK, GRAY, LIGHT, EYE, STORED = "#455a64", "#b0bec5", "#f59f00", "#1c7ed6", "#e03131"
_STYLE = "font-family:sans-serif;font-size:13px"


class Drawing:
    """Shapes in pixels, y downward, on white so that it can be read on dark pages."""

    def __init__(self, width: int, height: int) -> None:
        self._size = width, height
        self._shapes = [f'<rect width="{width}" height="{height}" fill="white"/>']

    def line(self, points: Iterable[Point], color: str, width: float = 1.2, dashes: str = "") -> None:
        """A line through points."""
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        dash = f' stroke-dasharray="{dashes}"' if dashes else ""
        self._shapes.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}"{dash}/>')

    def circle(
        self, center: Point, radius: float, fill: str = "none", stroke: str = "none", opacity: float = 1
    ) -> None:
        """A circle."""
        x, y = center
        self._shapes.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" fill="{fill}" stroke="{stroke}" '
            f'stroke-width="1.5" fill-opacity="{opacity:g}"/>'
        )

    def box(self, low: Point, high: Point, fill: str = "none", stroke: str = "none", opacity: float = 1) -> None:
        """A rectangle."""
        (x, y), (right, bottom) = low, high
        self._shapes.append(
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{right - x:.1f}" height="{bottom - y:.1f}" fill="{fill}" '
            f'stroke="{stroke}" fill-opacity="{opacity:g}"/>'
        )

    def text(self, place: Point, words: str, color: str = INK, anchor: str = "middle") -> None:
        """Words at a place."""
        x, y = place
        self._shapes.append(
            f'<text x="{x:.1f}" y="{y:.1f}" fill="{color}" text-anchor="{anchor}" style="{_STYLE}">{words}</text>'
        )

    def write(self, name: str) -> None:
        """Write NAME.svg."""
        width, height = self._size
        size = f'width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>'
        # REUSE-IgnoreStart
        license_line = "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->"
        # REUSE-IgnoreEnd
        text = "\n".join([head, license_line, *self._shapes, "</svg>"])
        (FOLDER / f"{name}.svg").write_text(text + "\n", encoding="utf-8")


def refracted(direction: Point, normal: Point, ratio: float) -> Point | None:
    """A unit direction behind a surface by Snell's law; None where all is reflected. ratio: of indices, n1 / n2."""
    cosine = -(direction[0] * normal[0] + direction[1] * normal[1])
    sine_squared = ratio**2 * (1.0 - cosine**2)
    if sine_squared > 1.0:
        return None
    along = ratio * cosine - math.sqrt(1.0 - sine_squared)
    return ratio * direction[0] + along * normal[0], ratio * direction[1] + along * normal[1]


def through_ball(start: Point, direction: Point, center: Point, radius: float) -> list[Point]:
    """A ray from outside through a ball of glass: where it begins, enters and leaves, and a direction's end behind it;
    the ray alone where it misses or is reflected within."""
    offset = start[0] - center[0], start[1] - center[1]
    along = offset[0] * direction[0] + offset[1] * direction[1]
    inside = along**2 - (offset[0] ** 2 + offset[1] ** 2 - radius**2)
    if inside <= 0.0:
        return [start]
    enter = _ahead(start, direction, -along - math.sqrt(inside))
    within = refracted(direction, _outward(enter, center, radius), 1.0 / 1.5)
    if within is None:
        return [start]
    offset = enter[0] - center[0], enter[1] - center[1]
    leave = _ahead(enter, within, -2.0 * (offset[0] * within[0] + offset[1] * within[1]))
    outward = _outward(leave, center, radius)
    behind = refracted(within, (-outward[0], -outward[1]), 1.5)
    return [start] if behind is None else [start, enter, leave, _ahead(leave, behind, 1.0)]


def _ahead(point: Point, direction: Point, length: float) -> Point:
    return point[0] + length * direction[0], point[1] + length * direction[1]


def _outward(point: Point, center: Point, radius: float) -> Point:
    return (point[0] - center[0]) / radius, (point[1] - center[1]) / radius


def _to_floor(path: Sequence[Point], floor: float) -> list[Point]:
    """A path whose last point is moved along its last stretch to the floor."""
    (x0, y0), (x1, y1) = path[-2:]
    return [*path[:-1], _ahead((x0, y0), (x1 - x0, y1 - y0), (floor - y0) / (y1 - y0))]


def draw_photons() -> None:
    """Photons come from the light through glass, a path from the eye; they meet on the floor."""
    drawing = Drawing(680, 300)
    light, ball, radius, floor, eye = (330.0, 28.0), (330.0, 140.0), 52.0, 262.0, (52.0, 92.0)
    drawing.box((20, floor), (660, floor + 6), fill=GRAY)
    hits = []
    for step in range(-30, 31):
        angle = math.radians(1.0 * step + 0.2)
        path = through_ball(light, (math.sin(angle), math.cos(angle)), ball, radius)
        if len(path) == 1:
            path = [light, _ahead(light, (math.sin(angle), math.cos(angle)), 1.0)]
        path = _to_floor(path, floor)
        if not 20.0 < path[-1][0] < 660.0:
            continue
        hits.append(path[-1])
        if step % 3 == 0:
            drawing.line(path, LIGHT, 0.8)
    for x, _ in hits:
        drawing.circle((x, floor - 2.0), 2.6, fill=STORED)
    drawing.circle(ball, radius, fill="#a5d8ff", stroke=INK, opacity=0.25)
    drawing.circle(light, 8, fill=LIGHT)
    point = (345.0, floor)
    drawing.line([eye, point], EYE, 1.8)
    drawing.circle(eye, 7, fill=EYE)
    drawing.line([(point[0] - 26, floor + 11), (point[0] + 26, floor + 11)], EYE, 4)
    drawing.text((light[0] + 16, light[1] + 4), "light: photons go out", LIGHT, "start")
    drawing.text((eye[0] - 10, eye[1] - 16), "camera", EYE, "start")
    drawing.text((ball[0] + radius + 12, ball[1]), "glass bends them", INK, "start")
    drawing.text((point[0], floor + 32), "the point looks for photons within its radius", EYE)
    drawing.text((478, floor - 14), "stored photons", STORED, "start")
    drawing.write("photons_and_importons")


def draw_radii() -> None:
    """The disk in which photons count shrinks from sample to sample, by Eq. 2."""
    drawing = Drawing(680, 230)
    numbers = random.Random(4)  # nosec B311
    alpha = 0.7
    for place, samples in enumerate((1, 8, 64)):
        center, side = (115.0 + 225.0 * place, 105.0), 95.0
        shrunk = math.sqrt(math.prod((step + alpha) / (step + 1.0) for step in range(1, samples)))
        radius = 82.0 * shrunk
        drawing.box((center[0] - side, center[1] - side), (center[0] + side, center[1] + side), stroke=GRAY)
        for _ in range(120):
            # A caustic: most photons lie near an arc.
            angle, distance = numbers.uniform(-0.5, 0.5), 190.0 + numbers.gauss(0.0, 6.0)
            x, y = center[0] - 175.0 + distance * math.cos(angle), center[1] + distance * math.sin(angle)
            drawing.circle((x, y), 1.6, fill=STORED)
        drawing.circle(center, radius, fill=EYE, stroke=EYE, opacity=0.12)
        drawing.circle(center, 2.5, fill=EYE)
        drawing.text((center[0], 222), f"sample {samples}: {shrunk:.0%} of the first radius")
    drawing.write("shrinking_radius")


def draw_deep_cubemap() -> None:
    """A ray goes through the cells of a cubemap's face, and tests the triangles of those alone."""
    drawing = Drawing(680, 340)
    center, half, cells = (170.0, 160.0), 120.0, 6
    low = center[0] - half, center[1] - half
    side = 2.0 * half / cells
    drawing.box(low, (center[0] + half, center[1] + half), stroke=INK)
    for step in range(1, cells):
        edge = -half + step * side
        for end in ((edge, -half), (edge, half), (-half, edge), (half, edge)):
            drawing.line([center, (center[0] + end[0], center[1] + end[1])], GRAY, 0.6)
    shapes = {"a": [(205, 70), (255, 62), (262, 104)], "b": [(228, 122), (282, 150), (240, 168)],
              "c": [(92, 220), (140, 236), (108, 264)], "d": [(60, 92), (98, 78), (94, 120)]}  # fmt: skip
    for name, corners in shapes.items():
        drawing.line([*corners, corners[0]], INK, 1.6)
        drawing.text((sum(x for x, _ in corners) / 3, sum(y for _, y in corners) / 3 + 5), name)
    drawing.circle(center, 4, fill=STORED)
    start, end = (196.0, 44.0), (268.0, 246.0)
    drawing.line([start, end], LIGHT, 2.4)
    drawing.text((start[0] - 8, start[1] + 18), "ray", LIGHT, "end")
    drawing.text((center[0], 306), "from the center, each direction is a cell of a face")
    # What the cells that the ray passes keep, and those beside them.
    rays: dict[int, list[float]] = {}
    for step in range(401):
        point = _between(start, end, step / 400)
        rays.setdefault(_cell(point, center, cells), []).append(_depth(point, center) / half)
    spans: dict[int, dict[str, list[float]]] = {}
    for name, corners in shapes.items():
        for point in _inside(corners):
            depths = spans.setdefault(_cell(point, center, cells), {}).setdefault(name, [])
            depths.append(_depth(point, center) / half)
    passed = list(rays)
    left, top = 400.0, 50.0
    drawing.text((left + 115, top - 18), "what lies in each cell, by distance")
    rows = [(passed[0] - 1) % (4 * cells), *passed, (passed[-1] + 1) % (4 * cells)]
    for number, cell in enumerate(rows):
        y = top + 24.0 * number
        drawing.box((left, y), (left + 230, y + 19), LIGHT if cell in passed else GRAY, GRAY, 0.3)
        for name, depths in spans.get(cell, {}).items():
            near, far = left + 230 * min(depths), left + 230 * max(depths)
            drawing.box((near, y + 3), (far, y + 16), fill=INK, opacity=0.85)
            drawing.text((0.5 * (near + far), y + 14), name, "white")
        if cell in rays:
            drawing.line([(left + 230 * depth, y + 9.5) for depth in (min(rays[cell]), max(rays[cell]))], LIGHT, 4)
    drawing.text((left, top + 24.0 * len(rows) + 14), "center", INK, "start")
    drawing.text((left + 230, top + 24.0 * len(rows) + 14), "far", INK, "end")
    drawing.write("deep_cubemap")


def _between(start: Point, end: Point, fraction: float) -> Point:
    return start[0] + fraction * (end[0] - start[0]), start[1] + fraction * (end[1] - start[1])


def _cell(point: Point, center: Point, cells: int) -> int:
    """Number of a direction's cell, round the center, of faces with so many cells each."""
    x, y = point[0] - center[0], point[1] - center[1]
    if abs(y) >= abs(x):
        face, across = (0, x / -y) if y < 0.0 else (2, -x / y)
    else:
        face, across = (1, y / x) if x > 0.0 else (3, -y / -x)
    return face * cells + min(int(0.5 * (across + 1.0) * cells), cells - 1)


def _depth(point: Point, center: Point) -> float:
    """Distance from the center as faces of a cubemap count it."""
    return max(abs(point[0] - center[0]), abs(point[1] - center[1]))


def _inside(corners: Sequence[Point], steps: int = 60) -> Iterable[Point]:
    """Points all over a triangle."""
    for i in range(steps + 1):
        for j in range(steps + 1 - i):
            u, v, w = i / steps, j / steps, (steps - i - j) / steps
            (x0, y0), (x1, y1), (x2, y2) = corners
            yield u * x0 + v * x1 + w * x2, u * y0 + v * y1 + w * y2


def draw_icon(size: int = 256, finer: int = 4) -> None:
    """Rays through a ball of glass that meet on the floor, for extensions.blender.org."""
    side = size * finer
    light, ball, radius, floor = (0.5 * side, -0.35 * side), (0.5 * side, 0.4 * side), 0.29 * side, 0.86 * side
    icon = Image.new("RGB", (side, side), "#1f2a33")
    pen = ImageDraw.Draw(icon, "RGBA")
    pen.rectangle([0, floor, side, side], fill="#37474f")
    for step in range(-16, 17):
        angle = math.radians(1.35 * step)
        path = through_ball(light, (math.sin(angle), math.cos(angle)), ball, radius)
        if len(path) > 1:
            pen.line(_to_floor(path, floor), fill=(255, 190, 60, 200), width=2 * finer)
    pen.ellipse([0.36 * side, 0.845 * side, 0.64 * side, 0.885 * side], fill=(255, 240, 200, 255))
    box = [ball[0] - radius, ball[1] - radius, ball[0] + radius, ball[1] + radius]
    pen.ellipse(box, fill=(150, 205, 255, 50), outline="#a5d8ff", width=2 * finer)
    icon.resize((size, size), Image.Resampling.LANCZOS).save(FOLDER / "icon.png", optimize=True)


if __name__ == "__main__":
    draw_icon()
    draw_photons()
    draw_radii()
    draw_deep_cubemap()
