# SPDX-License-Identifier: GPL-3.0-or-later
"""What every program of an iteration is bound to cost on a GPU, before there is one."""
