"""Draw plots as SVG: axes with round ticks, curves, bands and points.

Colours are classes of the style sheet, which serves light and dark screens and paper.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, log10

from markupsafe import Markup

from .render import element
from .words import MINUS

_MOST_TICKS = 6
_MARGIN_LEFT, _MARGIN_RIGHT, _MARGIN_TOP, _MARGIN_BOTTOM = 62.0, 12.0, 26.0, 44.0
Values = Sequence[float]


@dataclass(frozen=True)
class Frame:
    """Place a plot in a picture, and convert data to pixels."""

    left: float
    top: float
    width: float
    height: float
    """The whole plot with its labels, pixels."""
    x: tuple[float, float]
    y: tuple[float, float]
    """Lowest and highest value shown on either axis."""

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Give the pixels of a point, kept within the frame."""
        across = min(max((x - self.x[0]) / (self.x[1] - self.x[0]), 0.0), 1.0)
        up = min(max((y - self.y[0]) / (self.y[1] - self.y[0]), 0.0), 1.0)
        return round(self._begin + across * self._wide, 1), round(self._floor - up * self._high, 1)

    @property
    def _begin(self) -> float:
        return self.left + _MARGIN_LEFT

    @property
    def _wide(self) -> float:
        return self.width - _MARGIN_LEFT - _MARGIN_RIGHT

    @property
    def _floor(self) -> float:
        return self.top + self.height - _MARGIN_BOTTOM

    @property
    def _high(self) -> float:
        return self.height - _MARGIN_TOP - _MARGIN_BOTTOM

    def axes(self, title: str, x_label: str, y_label: str) -> Markup:
        """Draw grid, tick labels and axis labels."""
        middle = self._begin + self._wide / 2.0
        side = (self.left + 13.0, self._floor - self._high / 2.0)
        return Markup("").join(
            [
                *(self._tick_across(value) for value in ticks(*self.x)),
                *(self._tick_up(value) for value in ticks(*self.y)),
                element("text", title, x=self._begin, y=self.top + 14.0, class_="title"),
                element("text", x_label, x=middle, y=self._floor + 36.0, text_anchor="middle"),
                element(
                    "text",
                    y_label,
                    x=side[0],
                    y=side[1],
                    text_anchor="middle",
                    transform=f"rotate(-90 {side[0]} {side[1]})",
                ),
            ]
        )

    def line(self, x: Values, y: Values, kind: str) -> Markup:
        """Draw a curve."""
        points = [self.at(*point) for point in zip(x, y, strict=True)]
        return element("polyline", points=_points(points), class_=f"line {kind}")

    def band(self, x: Values, low: Values, high: Values, kind: str) -> Markup:
        """Fill what lies between two curves."""
        there = [self.at(*point) for point in zip(x, low, strict=True)]
        back = [self.at(*point) for point in zip(x, high, strict=True)]
        return element("polygon", points=_points([*there, *reversed(back)]), class_=f"band {kind}")

    def dots(self, x: Values, y: Values, kind: str) -> Markup:
        """Draw points."""
        pixels = [self.at(*point) for point in zip(x, y, strict=True)]
        return Markup("").join(
            element("circle", cx=across, cy=down, r=3.2, class_=f"dot {kind}") for across, down in pixels
        )

    def zero(self) -> Markup:
        """Draw the zero line where it is in range."""
        if not self.y[0] < 0.0 < self.y[1]:
            return Markup("")
        return self.line(self.x, (0.0, 0.0), "zero")

    def _tick_across(self, value: float) -> Markup:
        across, down = self.at(value, self.y[0])
        rule = element("line", x1=across, x2=across, y1=down, y2=round(down - self._high, 1), class_="grid")
        return rule + element("text", _short(value), x=across, y=down + 16.0, text_anchor="middle")

    def _tick_up(self, value: float) -> Markup:
        across, down = self.at(self.x[0], value)
        rule = element("line", x1=across, x2=round(across + self._wide, 1), y1=down, y2=down, class_="grid")
        return rule + element("text", _short(value), x=across - 6.0, y=down + 4.0, text_anchor="end")


def picture(title: str, description: str, size: tuple[float, float], *parts: object) -> Markup:
    """Put drawn parts in a picture with a title and a description for screen readers."""
    width, height = size
    return element(
        "svg",
        element("title", title),
        element("desc", description),
        *parts,
        viewBox=f"0 0 {width:g} {height:g}",
        role="img",
        xmlns="http://www.w3.org/2000/svg",
    )


def ticks(low: float, high: float) -> list[float]:
    """Give round values in a range.

    Examples
    --------
    >>> ticks(-0.23, 0.71)
    [-0.2, 0.0, 0.2, 0.4, 0.6]
    """
    if not high > low:
        return [low]
    rough = (high - low) / _MOST_TICKS
    scale = 10.0 ** floor(log10(rough))
    step = next(scale * factor for factor in (1.0, 2.0, 5.0, 10.0) if scale * factor >= rough)
    begin, end = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return [round(index * step, 12) + 0.0 for index in range(begin, end + 1)]


def span(*groups: Values, margin: float = 0.06) -> tuple[float, float]:
    """Give the range of all values with a margin.

    Examples
    --------
    >>> span([0.0, 1.0], [2.0], margin=0.5)
    (-1.0, 3.0)
    """
    values = [value for group in groups for value in group]
    low, high = (min(values), max(values)) if values else (0.0, 1.0)
    room = margin * (high - low) or max(abs(high), 1.0) * 0.1
    return low - room, high + room


def _points(pixels: Sequence[tuple[float, float]]) -> str:
    return " ".join(f"{across:g},{down:g}" for across, down in pixels)


def _short(value: float) -> str:
    return f"{value:.6g}".replace("-", MINUS)
