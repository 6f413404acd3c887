# SPDX-License-Identifier: GPL-3.0-or-later
"""Small parts of files, such as strangers' files hold and the other kinds lack, which stand side by side."""
