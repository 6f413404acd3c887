# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm farm: frames of an animation, or parts of a still, shared among processes and machines by dask.distributed."""
