# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in files and messages: documents, fingerprints, sharing between frames, and validation of what comes in."""
