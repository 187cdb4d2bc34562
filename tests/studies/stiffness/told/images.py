"""Images as numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def pixels(path: Path) -> np.ndarray:
    """An image as (height, width, 3) bytes: as numbers, a page of the browser's would take a quarter of a gigabyte."""
    from PIL import Image

    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))
