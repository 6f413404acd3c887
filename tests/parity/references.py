# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' results for the tests' scenes, kept in tests/parity/references/: a file for each test module.

A scene's digest finds what was kept of it, so that a scene that changed is noticed. ``make parity`` renders Cycles'
side anew and compares it with what is kept; ``make references`` keeps it. Other Blenders than the one that it was
made with render for themselves.
"""

import enum
import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np

from .scene_digest import scene_digest

FOLDER = Path(__file__).parent / "references"
BLOCK = 8
"""Pixels a side of the blocks whose means are kept exactly, as comparison.py compares them."""
ROUNDING = 2.0**-22
"""Relative rounding error of float32, twice."""
SIGMAS = 6.0
"""By which two renders may differ. A block's error is known from two seeds and its neighbors, 18 degrees of freedom in
all: Student's t beyond 6 has a probability of 1e-5, of 64 blocks in 100 pictures 7 in 100 runs on another processor;
on the same one Cycles repeats its pictures."""


class Mode(enum.Enum):
    """Where Cycles' side comes from."""

    RENDER = "render"
    """Cycles, each time."""
    KEPT = "kept"
    """The files."""
    COMPARE = "compare"
    """Cycles; the files must agree with it."""
    WRITE = "write"
    """Cycles; the files are written anew."""


class ReferenceMissing(AssertionError):
    """Nothing is kept of a scene."""


@dataclass
class _State:
    mode: Mode = Mode.RENDER
    test_file: Path = Path()
    """Path of the running test's file, from the checkout on; its stem names the file of references."""
    written: dict[str, np.ndarray] = field(default_factory=dict)
    """Arrays that the module's tests asked for in mode WRITE, by name in the file."""


_state = _State()


def use(mode: Mode) -> None:
    """Take Cycles' side from there from now on."""
    _state.mode = mode


def mode() -> Mode:
    """Where Cycles' side comes from now."""
    return _state.mode


def begin(test_file: Path) -> None:
    """Tests of a module begin."""
    _state.test_file = test_file


def only_cycles() -> bool:
    """Whether nothing but Cycles' side is asked for."""
    return _state.mode in (Mode.COMPARE, Mode.WRITE)


def light(render: Callable[[], np.ndarray], seeds: int) -> np.ndarray:
    """Pictures of the current scene, (seeds, H, W, C) float64, as ``render`` makes them.

    Of what is kept the means of blocks are exact for each seed; within a block all seeds have the detail of their mean,
    coarsely rounded.
    """
    if mode() is Mode.RENDER or (mode() is not Mode.WRITE and bpy.app.version_string != _blender_of_files()):
        return render()
    name = f"{seeds}_{scene_digest()}"
    if mode() is Mode.WRITE:
        found = render()
        parts = {f"{name}/{part}": array for part, array in packed(found).items()}
        _state.written.update(parts)
        return found
    file = _file()
    kept = {part.partition("/")[2]: array for part, array in _read(file).items() if part.partition("/")[0] == name}
    if not kept:
        raise ReferenceMissing(
            f"tests/parity/references/{file.name} has nothing of this scene: it is new, or the scene, Cycles' settings "
            "or scene_digest.py changed. Keep what Cycles gives now:\n"
            f"    make references TESTS={_state.test_file.as_posix()}"
        )
    if mode() is Mode.COMPARE:
        found = render()
        compare(found, unpacked(kept), f"tests/parity/references/{file.name}")
        return found
    return unpacked(kept)


def _file() -> Path:
    return FOLDER / f"{_state.test_file.stem}.npz"


def _blender_of_files() -> str:
    return (FOLDER / "blender_version.txt").read_text(encoding="utf-8").strip()


@functools.lru_cache(maxsize=2)
def _read(file: Path) -> dict[str, np.ndarray]:
    if not file.exists():
        return {}
    with np.load(file) as stored:
        return dict(stored)


def write(keep_others: bool) -> None:
    """In mode WRITE, write what the current module's tests asked for; keep what else its file holds or drop it."""
    arrays, _state.written = _state.written, {}
    if not arrays:
        return
    FOLDER.mkdir(exist_ok=True)
    before = _read(_file()) if keep_others else {}
    np.savez_compressed(_file(), **dict(sorted((before | arrays).items())))
    (FOLDER / "blender_version.txt").write_text(bpy.app.version_string + "\n", encoding="utf-8")


def _block_means(pictures: np.ndarray) -> np.ndarray:
    """(..., H, W, C) to (..., H / 8, W / 8, C)."""
    *outer, height, width, channels = pictures.shape
    blocks = pictures.reshape(*outer, height // BLOCK, BLOCK, width // BLOCK, BLOCK, channels)
    return blocks.mean(axis=(-4, -2))


def _enlarged(blocks: np.ndarray) -> np.ndarray:
    return blocks.repeat(BLOCK, axis=-3).repeat(BLOCK, axis=-2)


def packed(pictures: np.ndarray) -> dict[str, np.ndarray]:
    """Means of blocks, and the detail of the seeds' mean: 4 bits of exponent below the largest value, 4 of mantissa."""
    assert (pictures >= 0.0).all(), "light is not negative"
    mean = pictures.mean(axis=0)
    if np.ptp(mean[..., 3]) == 0.0:
        mean = mean[..., :3]
    fraction, exponent = np.frexp(mean / max(mean.max(), 1e-30))
    code = 16 * (exponent + 14) + np.floor((2.0 * fraction - 1.0) * 16.0)
    detail = np.where(mean > 0.0, np.clip(code, 1, 255), 0).astype(np.uint8)
    return {"detail": detail, "blocks": _block_means(pictures).astype(np.float32)}


def unpacked(kept: dict[str, np.ndarray]) -> np.ndarray:
    code, blocks = kept["detail"].astype(np.int32), kept["blocks"].astype(np.float64)
    detail = np.where(code > 0, np.ldexp(1.0 + (code % 16 + 0.5) / 16.0, code // 16 - 15), 0.0)
    if detail.shape[-1] < blocks.shape[-1]:
        detail = np.concatenate([detail, np.ones((*detail.shape[:2], 1))], axis=-1)
    level = np.broadcast_to(_block_means(detail), blocks.shape)
    ratios = np.divide(blocks, level, out=np.zeros_like(blocks), where=level > 0.0)
    return detail * _enlarged(ratios)


def compare(found: np.ndarray, kept: np.ndarray, file: str) -> None:
    a, b = _block_means(found), _block_means(kept)
    difference = np.abs(a.mean(axis=0) - b.mean(axis=0))
    noise = 0.0
    if len(found) > 1:
        both = (a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / len(found)
        padded = np.pad(both, ((1, 1), (1, 1), (0, 0)), mode="edge")
        rows, columns, _ = both.shape
        around = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
        noise = np.sqrt(np.mean(around, axis=0))
    excess = difference - SIGMAS * noise - ROUNDING * b.mean(axis=0)
    worst = np.unravel_index(np.argmax(excess), excess.shape)
    assert excess[worst] <= 0.0, (
        f"{file} is not what Cycles gives: block {worst[:2]} has {b.mean(axis=0)[worst]:.5g} there and "
        f"{a.mean(axis=0)[worst]:.5g} anew; if Cycles is right, run make references"
    )
