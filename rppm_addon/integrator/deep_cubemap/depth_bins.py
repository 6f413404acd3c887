# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth bins for cells that hold much and cannot be divided with gain."""

from .build_buffers import BuildBuffers
from .hierarchy import Level


def sort_into_bins(buffers: BuildBuffers, last_level: Level) -> None:
    """Sort the fragments of such cells by depth, with a counting sort.

    Raises LevelTooFineError where the device has no room for the bins, and ListTooShortError as
    BuildBuffers.read_complete_state does.
    """
    state = buffers.read_state()
    cell_count, fragment_count = int(state["binned_cell_count"]), int(state["binned_fragment_count"])
    if not fragment_count:
        return
    buffers.run("allocate_bins", cell_count)
    buffers.require_bins(int(buffers.read_state()["bin_count"]), last_level.number)
    buffers.run("count_entries", fragment_count)
    buffers.run("place_entries", cell_count)
    buffers.read_complete_state(last_level.number)
    buffers.run("scatter_entries", fragment_count)
