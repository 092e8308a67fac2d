import json

import numpy as np

from veritorque.core.robot.builtin import builtin_description
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.robot.writing import to_description

GANTRY = {
    "name": "gantry",
    "joints": [
        {"type": "prismatic", "alpha": 0.3, "d": 0.1, "r": 0.2, "theta_offset": -0.7},
        {
            "type": "revolute",
            "alpha": -1.1,
            "d": 0.4,
            "r": -0.3,
            "theta_offset": 2.0,
            "gamma": 0.5,
            "b": 0.25,
        },
        {"type": "revolute", "antecedent": 1, "alpha": 1.5, "d": -0.2, "r": 0.1, "theta_offset": 0.0},
    ],
}
MIMIC = """<robot name="hand"><link name="palm"/><link name="near"/><link name="far"/><link name="slide"/>
  <joint name="a" type="revolute"><parent link="palm"/><child link="near"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.3 -0.4 0.5"/><axis xyz="0.6 0 0.8"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="b" type="revolute"><parent link="near"/><child link="far"/><origin xyz="0 0.1 0" rpy="1 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/>
    <mimic joint="a" multiplier="-0.5" offset="0.2"/></joint>
  <joint name="c" type="prismatic"><parent link="far"/><child link="slide"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
MINUS = "\N{MINUS SIGN}"
ROBOTS = {
    "yumi": builtin_description("yumi"),
    "gantry": to_description(robot_from_description(GANTRY)),
    "mimic": to_description(robot_from_urdf(MIMIC)),
}


def poses(robot, coordinates):
    """Place the frames by core's own links."""
    placed = []
    for link in robot.links:
        moved = link.ratio * coordinates[link.joint - 1] + link.offset
        turned = np.eye(3)
        along = link.translation
        if link.kind == "revolute":
            c, s = np.cos(moved), np.sin(moved)
            turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        else:
            along = along + moved * link.rotation[:, 2]
        rotation, origin = placed[link.antecedent - 1] if link.antecedent else (np.eye(3), np.zeros(3))
        placed.append((rotation @ link.rotation @ turned, origin + rotation @ along))
    return placed


def test_the_figure_stands_where_the_service_says(look, service):
    page = look(service).open("/compare")
    for name, description in ROBOTS.items():
        robot = robot_from_description(description)
        coordinates = np.random.default_rng(1).uniform(-1.0, 1.0, len(robot.joints)).tolist()
        drawn = page.evaluate(
            """async (given) => (await import("/static/drawing/kinematics.js")).place(...given)""",
            [json.loads(json.dumps(description)), coordinates],
        )
        for seen, (rotation, origin) in zip(drawn, poses(robot, coordinates), strict=True):
            assert np.allclose(seen["rotation"], rotation, atol=1e-12), name
            assert np.allclose(seen["origin"], origin, atol=1e-12), name
            assert np.allclose(seen["path"][-1], origin, atol=1e-12), name


def test_an_ellipsoid_keeps_its_outline_whichever_way_it_is_seen(look, service):
    page = look(service).open("/compare")
    ball = {"link": 1, "centre": [0, 0, 0], "axes": [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]], "label": "ball"}
    sizes = page.evaluate(
        """async ([description, body]) => {
          const { drawChain } = await import("/static/drawing/chain.js");
          const place = document.body.appendChild(document.createElement("div"));
          drawChain(place, description, { bodies: [body] });
          const stage = place.querySelector(".stage3d");
          const seen = [];
          for (const key of ["ArrowLeft", "ArrowUp", "ArrowUp", "ArrowRight"]) {
            stage.dispatchEvent(new KeyboardEvent("keydown", { key }));
            const drawn = place.querySelector(".body");
            seen.push(Number(drawn.getAttribute("rx")), Number(drawn.getAttribute("ry")));
          }
          return seen;
        }""",
        [ROBOTS["gantry"], ball],
    )
    assert min(sizes) > 1.0
    assert max(sizes) - min(sizes) <= 0.02  # a ball is a circle from everywhere; two decimals are written


def test_the_figure_turns_by_drag_and_by_keys_and_follows_the_sliders(look, service):
    seen = look(service)
    page = seen.open("/new?robot=yumi-left")
    page.locator(".stage3d .joint").first.wait_for()
    shapes = [page.locator(".stage3d svg").inner_html()]

    def moved():
        shapes.append(page.locator(".stage3d svg").inner_html())
        return shapes[-1] != shapes[-2]

    page.locator(".stage3d").focus()
    page.keyboard.press("ArrowLeft")
    assert moved()
    box = page.locator(".stage3d").bounding_box()
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] + 160, box["y"] + 130)
    page.mouse.up()
    assert moved()
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    assert not moved()
    page.get_by_label("joint_4").focus()
    page.keyboard.press("ArrowRight")
    assert moved()
    page.get_by_role("button", name="Zero pose").click()
    assert moved()
    assert shapes[-1] == shapes[-3]
    slide = """async (description) => {
      const { drawChain } = await import("/static/drawing/chain.js");
      const place = document.body.appendChild(document.createElement("div"));
      drawChain(place, description);
      const slider = place.querySelector("input[type=range]");
      [slider.min, slider.max, slider.step] = [4e-16, 1, 0.1];
      slider.value = 0;
      slider.dispatchEvent(new Event("input"));
      const figure = place.querySelector("svg").ariaLabel;
      return [slider.valueAsNumber, place.querySelector("output").textContent, figure];
    }"""
    value, told, figure = page.evaluate(slide, ROBOTS["gantry"])
    assert 0.0 < value < 1e-15
    assert told == "0 m"
    assert "e" + MINUS not in figure
