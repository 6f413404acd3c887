# SPDX-License-Identifier: GPL-3.0-or-later
"""What rays are traced through, whichever structure it is."""
