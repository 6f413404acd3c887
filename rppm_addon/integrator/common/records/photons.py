# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons that a path leaves where it meets surfaces."""

from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock

PHOTON = Record(
    "Photon",
    position="vec3",
    flags="uint",
    flux="vec3",
    geometric_normal="uint",
    direction="vec3",
    distance="float",
    path="uint",
    depth="uint",
    bounce_counts="uint",
    unused="uint",
)
"""One light path vertex, 64 bytes (paper section 5.1). Those of a segment follow each other as its active paths do.
``direction`` points back to where the photon came from, which is ``distance`` meters away, straight through what is
transparent. The upper bits of ``flags`` are those of the radius of its footprint, meters, 0 where that is not known.
``path`` is the number of its path, with that of the segment above (PhotonNumbers); ``depth`` that of the path (Depths),
with PHOTON_CONTRIBUTED once an importon takes it, and ``bounce_counts`` those of the path,
with PHOTON_IN_MEDIUM where a medium has scattered it, and no surface; the flux is then what the medium scatters, in all
directions together."""
PHOTON_SEGMENT_SHIFT = 22
"""Photons of an iteration are fewer (MOST_PHOTONS), and segments than what is left of a word (MOST_SEGMENTS)."""
PHOTON_CONTRIBUTED = 1 << 31
PHOTON_IN_MEDIUM = 1 << 31
Constants("PhotonsInMedia", PHOTON_IN_MEDIUM=PHOTON_IN_MEDIUM)
Constants("PhotonNumbers", PHOTON_SEGMENT_SHIFT=PHOTON_SEGMENT_SHIFT, PHOTON_CONTRIBUTED=PHOTON_CONTRIBUTED)
StorageBlock("PhotonRange", "uint photon_first; uint photon_end;")
"""Range of the photons of the current segment among those of the iteration."""
StorageBlock("Photons", "Photon photons[];")
StorageBlock(
    "StoredPhotons", "uint stored_count; uint global_photon_count; uint indirect_count; uint stored_photons[];"
)
"""Numbers of the stored photons, behind the counts of all of them, of the global and of the indirect ones."""
