# SPDX-License-Identifier: GPL-3.0-or-later
"""Deep cubemap and estimator on a device: what `make bench` measures."""
