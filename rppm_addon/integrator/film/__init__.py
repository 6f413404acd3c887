# SPDX-License-Identifier: GPL-3.0-or-later
"""The film: running means of radiance and of the passes, the listeners that fill them, and the noise."""
