"""Moving pictures: a figure that can show a time, and the GIF of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from golden.support.files import atomic_file
from sim.figures import body, paper

DPI = 100
FRAMES, EVERY, PAUSE = 48, 100, 1500  # pictures, ms for each, ms for the last one
GREYS, SHADES = 16, 48  # colours in the palette of all films


@dataclass(frozen=True, eq=False)
class Film:
    """A figure, the function that makes it show a time (s), and the first and last time to show."""

    figure: Figure
    show: Callable[[float], None]
    start: float
    end: float

    def times(self) -> np.ndarray:
        return np.linspace(self.start, self.end, FRAMES)


def save(film: Film, path: Path, progress: Callable[[int], object] | None = None) -> None:
    """Write the film as a GIF that repeats; ``progress(pictures drawn)``."""
    pictures = []
    for number, time in enumerate(film.times(), 1):
        film.show(float(time))
        pictures.append(picture(film))
        if progress:
            progress(number)
    first, *others = (each.quantize(palette=palette(), dither=Image.Dither.NONE) for each in pictures)
    with atomic_file(path) as file:
        first.save(
            file,
            format="GIF",
            save_all=True,
            append_images=others,
            loop=0,
            optimize=False,
            duration=[EVERY] * len(others) + [PAUSE],
        )


def picture(film: Film) -> Image.Image:
    """Return the figure as it is now."""
    film.figure.set_dpi(DPI)
    canvas = FigureCanvasAgg(film.figure)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def palette() -> Image.Image:
    """Return one palette for all films: what stands still then has the same colours in each picture, which a GIF stores
    once, and the colour bar keeps its shades."""
    greys = np.linspace(0, 1, GREYS)[:, None].repeat(3, axis=1)
    shades = body.COLOURS(np.linspace(0, 1, SHADES))[:, :3]
    lines = np.array([to_rgb(colour) for colour in paper.LINES])
    tints = [1 - (1 - lines) * strength for strength in (1, 0.65, paper.FLOAT["alpha"], 0.15)]
    image = Image.new("P", (1, 1))
    image.putpalette(np.rint(255 * np.concatenate([greys, shades, *tints])).astype(np.uint8).tobytes())
    return image
