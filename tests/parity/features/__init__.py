# SPDX-License-Identifier: GPL-3.0-or-later
"""The parity suite: a small scene for each feature, rendered by RPPM and Cycles. See docs/compatibility.md."""
