"""Draw URDFs like public ones: arms on slides, several arms on one torso, grippers, skew axes, calibrations.

Each is drawn once and written twice: with angles as its author wrote them, and as they are meant. Both are
the same text but where a right angle was written with few decimals.
"""

from dataclasses import dataclass, field

import numpy as np

QUARTER = np.pi / 2
DECIMALS = (None, None, 12, 6, 5, 4)
"""With how many decimals an author writes angles; None for all digits."""
STYLES = ("exact", "written short", "milliradians", "calibrated", "skew")
"""What the angles of a robot are: right angles, those with few decimals, 1.57, as a calibration gives them
(beside right angles, and of any size below 3 mrad), and anything."""


@dataclass
class Drawing:
    """Collect the links and joints of one robot, in both writings."""

    rng: np.random.Generator
    style: str
    written: list[str] = field(default_factory=list)
    meant: list[str] = field(default_factory=list)
    masters: dict[str, list[str]] = field(default_factory=dict)
    links: int = 0

    def add_link(self) -> str:
        """Add a link; some have no body, some are point masses."""
        name = f"link_{self.links}"
        self.links += 1
        mass, *spread = map(float, self.rng.uniform((0.2, 0.0, 0.0, 0.0), (9.0, 0.05, 0.05, 0.05)))
        body = (
            f'<inertial><origin xyz="{_words(self.rng.normal(scale=0.1, size=3))}"/><mass value="{mass!r}"/>'
            f'<inertia ixx="{spread[0]!r}" iyy="{spread[1]!r}" izz="{spread[2]!r}" ixy="0" ixz="0" iyz="0"/>'
            "</inertial>"
        )
        self._write(f'<link name="{name}">{body if self.rng.random() < 0.9 else ""}</link>')
        return name

    def add_joint(self, parent: str, kind: str, *, mimics: bool = False) -> str:
        """Hang a new link on another one."""
        child, name = self.add_link(), f"joint_{self.links}"
        follows = self.masters.get(kind, []) if mimics else []
        inside = f"{self._axis()}"
        if follows:
            ratio, offset = float(self.rng.choice([-1.0, 1.0, 0.5])), float(self.rng.choice([0.0, 0.3]))
            inside += f'<mimic joint="{self.rng.choice(follows)}" multiplier="{ratio}" offset="{offset}"/>'
        elif kind != "fixed":
            self.masters.setdefault(kind, []).append(name)
        ends = f'<parent link="{parent}"/><child link="{child}"/>'
        xyz, (written, meant) = self._place(), self._angles()
        for parts, rpy in ((self.written, written), (self.meant, meant)):
            parts.append(
                f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}" rpy="{rpy}"/>{ends}{inside}'
                '<limit lower="-2" upper="2" effort="50" velocity="3"/></joint>'
            )
        return child

    def add_chain(self, parent: str, kinds: list[str]) -> str:
        """Hang a chain on a link; one joint in ten follows another one of its kind, as in a parallelogram."""
        for kind in kinds:
            parent = self.add_joint(parent, kind, mimics=self.rng.random() < 0.1)
        return parent

    def _write(self, text: str) -> None:
        self.written.append(text)
        self.meant.append(text)

    def _axis(self) -> str:
        axes = ("0 0 1", "0 0 1", "0 1 0", "1 0 0", "0 -1 0", "0 0 -1")
        skew = self.style == "skew" and self.rng.random() < 0.3
        return f'<axis xyz="{_words(self.rng.normal(size=3)) if skew else self.rng.choice(axes)}"/>'

    def _place(self) -> str:
        along = np.round(self.rng.uniform(-0.5, 0.5, 3), 3) * (self.rng.random(3) < 0.4)
        off = self.rng.normal(scale=3e-4, size=3) if self.style == "calibrated" else np.zeros(3)
        return _words(along + off)

    def _angles(self) -> tuple[str, str]:
        quarters = self.rng.choice([0, 0, 0, 1, -1, 2], size=3) * (self.rng.random(3) < 0.6)
        angles = QUARTER * quarters
        if self.style == "skew":
            return (_words(self.rng.uniform(-3.0, 3.0, 3)),) * 2
        if self.style == "calibrated":
            return (_words(angles + self.rng.normal(scale=1e-3, size=3) * (self.rng.random(3) < 0.6)),) * 2
        if self.style == "milliradians":
            return (_words(np.round(angles, 2)),) * 2
        decimals = DECIMALS[self.rng.integers(len(DECIMALS))] if self.style == "written short" else None
        return _words(angles if decimals is None else np.round(angles, decimals)), _words(angles)


def drawn_robot(seed: int) -> tuple[str, str]:
    """Draw a robot of the kind that the seed says; give its URDF as written and as meant."""
    rng = np.random.default_rng([seed, 38])
    drawing = Drawing(rng, STYLES[seed % len(STYLES)])
    base = drawing.add_link()
    shape = rng.choice(["arm", "arm", "on a slide", "two arms", "tree"])
    if shape == "on a slide":
        base = drawing.add_chain(base, ["prismatic"])
    if shape == "two arms":
        base = drawing.add_chain(base, [str(rng.choice(["fixed", "revolute", "prismatic"]))])
    tips = [drawing.add_chain(base, _kinds(rng)) for _ in range(2 if shape in ("two arms", "tree") else 1)]
    if shape == "tree":
        tips.append(drawing.add_chain(base, ["continuous", "revolute"]))
    if rng.random() < 0.5:
        _add_gripper(drawing, tips[0])
    return tuple(  # type: ignore[return-value]  # two texts
        f'<robot name="drawn {seed}">{"".join(parts)}</robot>' for parts in (drawing.written, drawing.meant)
    )


def _kinds(rng: np.random.Generator) -> list[str]:
    """Give the joints of an arm: mostly revolute, with a flange or a sensor welded in between."""
    share = {"revolute": 0.7, "continuous": 0.1, "prismatic": 0.1, "fixed": 0.1}
    return ["revolute", *map(str, rng.choice(list(share), size=rng.integers(2, 7), p=list(share.values())))]


def _add_gripper(drawing: Drawing, tip: str) -> None:
    hand = drawing.add_joint(tip, "fixed")
    drawing.add_joint(hand, "prismatic")
    drawing.add_joint(hand, "prismatic", mimics=True)


def _words(values: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in values)
