# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene on the device, brought up and kept up to date."""
