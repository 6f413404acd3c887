# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes pages beside docs/ into the site, and links to them; links to other files become names, pictures open large."""

import os
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[2]
BESIDE = ("CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
_OF_CHECKOUT = re.compile(r"\[([^\]]+)\]\((?!docs/|http|#)[^)]+\)")
_PICTURE = re.compile(r'<img [^>]*?src="([^"]+)"[^>]*>')
_COMMENT = re.compile(r"\A<!--.*?-->\s*", re.DOTALL)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Only where mike builds are there other versions to ask for."""
    if "MIKE_DOCS_VERSION" not in os.environ:
        del config.extra["version"]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages."""
    for name in BESIDE:
        text = _OF_CHECKOUT.sub(r"`\1`", (ROOT / name).read_text(encoding="utf-8")).replace("](docs/", "](")
        files.append(File.generated(config, name, content=text))
    return files


def on_page_markdown(markdown: str, **_: object) -> str:
    """Links out of docs/ to them stay in the site; pages begin with their headings, which name them in the menu."""
    for name in BESIDE:
        markdown = markdown.replace(f"](../{name}", f"]({name}")
    return _COMMENT.sub("", markdown)


def on_page_content(html: str, **_: object) -> str:
    """A click on a picture, which may be small in a table or on a phone, opens it in its own size."""
    return _PICTURE.sub(r'<a href="\1">\g<0></a>', html)
