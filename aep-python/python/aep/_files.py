"""Files are written whole or not at all."""

from __future__ import annotations

import os


def write(path: str | os.PathLike[str], text: str) -> None:
    """Writes beside the place and renames into it. Raises ``OSError`` where that cannot be done."""
    beside = f"{os.fspath(path)}.new"
    try:
        with open(beside, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        os.replace(beside, path)
    except BaseException:
        if os.path.exists(beside):
            os.unlink(beside)
        raise
