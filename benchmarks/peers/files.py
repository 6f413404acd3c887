# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes as the files that RPPM and Cycles read, made once for each description."""

import sys
from pathlib import Path

from .environments import OUT, run
from .scenes import make_scene

_LIMIT = 300.0


class PeersError(RuntimeError):
    """The comparison cannot go on."""


def make_file(command: list[str], path: Path, seconds: float = _LIMIT) -> None:
    """Run a program that writes a file, beside its log, in so many seconds at most. Raises PeersError."""
    path.unlink(missing_ok=True)
    problem = run(command, seconds, path.with_suffix(".log"))
    if problem or not path.exists():
        raise PeersError(f"{path.name} could not be made: {problem or 'no file'}")


class SceneFiles:
    """.blend and exported files of scenes, in a folder; a changed description makes them anew."""

    def __init__(self, resolution: int, folder: Path = OUT / "scenes") -> None:
        self._resolution = resolution
        self._folder = folder
        self._folder.mkdir(parents=True, exist_ok=True)

    def blend(self, name: str) -> Path:
        """The scene as Cycles opens it."""
        path = self._folder / f"{name}_{make_scene(name).fingerprint}.blend"
        if not path.exists():
            make_file([sys.executable, "-m", "benchmarks.peers.adapters.blend", name, str(path)], path)
        return path

    def saved(self, name: str) -> Path:
        """The scene as rppm export saves it, always anew: the exporter is part of what is measured."""
        blend = self.blend(name)
        path = blend.with_suffix(".npz")
        command = [sys.executable, "-m", "rppm_addon", "export", str(blend), "-o", str(path)]
        make_file([*command, "--resolution", f"{self._resolution}x{self._resolution}"], path)
        return path

    def of(self, adapter: str, name: str) -> str:
        """The file that an adapter reads, empty where it makes its scene itself."""
        if adapter == "cycles":
            return str(self.blend(name))
        return str(self.saved(name)) if adapter == "rppm" else ""
