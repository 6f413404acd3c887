# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds deep cubemaps, one after the other, in buffers that all of them use."""

import logging

import numpy as np

from ...gl.buffer_sets import BufferSet, Part
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from .build_buffers import BuildBuffers, LevelTooFineError, ListTooShortError
from .clusters import Clusters
from .depth_bins import sort_into_bins
from .hierarchy import Hierarchy
from .level_limit import LevelLimit
from .overlap import OverlapTest, list_overlap_jobs

log = logging.getLogger(__name__)

_MIN_TRIAL_TRIANGLES, _MAX_TRIAL_TRIANGLES = 1000, 16384
"""Triangles to try both routes with."""


class CubemapBuilder(BufferSet):
    """The buffers of builds, which hold what the last one made, and how triangles are found in cells."""

    remedy = BuildBuffers.remedy
    buffers = Part(BuildBuffers)

    def __init__(self, context: Context, library: ProgramLibrary, rasterize: bool | None) -> None:
        """rasterize: as that of DeepCubemap."""
        super().__init__(context, library)
        self._context = context
        self._overlap = self.own(OverlapTest(context, library, rasterize))
        self._level_limit = LevelLimit()

    def build(self, parameters: np.void, clusters: Clusters) -> np.void:
        """Sort what ``parameters``, a STATE, count into cells; returns the STATE of the cubemap, with the fragments of
        all levels. Raises DeviceError."""
        count = int(parameters["triangle_count"])
        self.buffers.reserve(count, clusters)
        if self._overlap.rasterizes is None and count >= _MIN_TRIAL_TRIANGLES and not clusters.are_boxes:
            self._overlap.rasterizes = self._is_faster_rasterized(parameters, clusters)
        fragment_count = self._build(parameters, clusters)
        state = self.buffers.read_state()
        state["fragment_count"] = fragment_count
        return state

    @property
    def route(self) -> str | None:
        """Way in which triangles are found in cells; None where that has not been decided yet."""
        return {True: "rasterization", False: "compute shader", None: None}[self._overlap.rasterizes]

    def _build(self, parameters: np.void, clusters: Clusters) -> int:
        """Build until all lists are long enough, with coarser cells where the device cannot hold them.

        Returns the number of fragments of all levels.
        """
        parameters = parameters.copy()
        self._level_limit.apply(parameters)
        while True:
            try:
                return self._sort(parameters, clusters)
            except ListTooShortError:
                continue
            except LevelTooFineError as error:
                self._level_limit.lower(parameters, error)

    def _sort(self, parameters: np.void, clusters: Clusters) -> int:
        """Sort the items into cells and bins; returns the number of fragments of all levels."""
        buffers = self.buffers
        hierarchy = Hierarchy(buffers, parameters)
        hierarchy.initialize_base(parameters)
        list_overlap_jobs(buffers, int(parameters["triangle_count"]), clusters)
        level = hierarchy.base_level()
        self._overlap.find_fragments(buffers, level, clusters)
        while (finer_level := hierarchy.divide(level)) is not None:
            level = finer_level
            self._overlap.find_fragments(buffers, level, clusters)
        sort_into_bins(buffers, level)
        hierarchy.merge(level)
        return hierarchy.fragment_count

    def _is_faster_rasterized(self, parameters: np.void, clusters: Clusters) -> bool:
        """Build with the first triangles by both routes, twice as the first time compiles, and compare the clock."""
        trial = parameters.copy()
        trial["triangle_count"] = min(int(trial["triangle_count"]), _MAX_TRIAL_TRIANGLES)
        seconds = {}
        for rasterizes in (False, True, False, True):
            self._overlap.rasterizes = rasterizes
            seconds[rasterizes] = self._context.seconds_of(lambda: self._build(trial, clusters))
        log.debug("deep cubemap: %.1f ms by compute shader, %.1f ms rasterized", *(1e3 * s for s in seconds.values()))
        return seconds[True] < seconds[False]
