import json
import math
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest

from tests.app.planar_arm import columns, csv_log

MINUS = "\N{MINUS SIGN}"


@pytest.fixture(scope="module")
def odd_log(tmp_path_factory):
    """A log whose names say nothing to a reader: degrees, milliseconds, milli-newton-metres."""
    time, position, torque = columns(seconds=4.0)
    lines = ["clock_ms,pos_b,pos_a,effort_b,effort_a,note"]
    for stamp, (first, second), (tau_1, tau_2) in zip(time, position, torque, strict=True):
        angles = f"{math.degrees(second):.6f},{math.degrees(first):.6f}"
        lines.append(f"{stamp * 1e3:.3f},{angles},{tau_2 * 1e3:.3f},{tau_1 * 1e3:.3f},0")
    path = tmp_path_factory.mktemp("odd") / "odd.csv"
    path.write_text("\n".join(lines))
    return path


@pytest.fixture(scope="module")
def holed_log(tmp_path_factory):
    """A log that stops for a second in the middle."""
    rows = csv_log(seconds=8.0).decode().split("\n")
    path = tmp_path_factory.mktemp("holed") / "holed.csv"
    path.write_text("\n".join([*rows[:600], *rows[800:]]))
    return path


def posted(page, path, act):
    """Give what a page sends to a path while something is done."""
    with page.expect_request(lambda request: path in request.url and request.method == "POST") as asked:
        act()
    return asked.value


def test_a_table_in_degrees_and_millimetres_is_sent_in_si(look, service):
    seen = look(service)
    page = seen.open("/new")
    page.get_by_role("radio", name="DH table").check()
    page.get_by_role("radio", name="mm", exact=True).check()
    page.get_by_label("Name", exact=True).fill("typed arm")
    page.get_by_role("button", name="Remove joint 3").click()
    typed = {
        "Joint 1: alpha, deg": "0", "Joint 1: d, mm": "0",
        "Joint 1: theta, deg": "-180", "Joint 1: r, mm": "166",
        "Joint 1: minimum q, deg": "-168,5", "Joint 1: maximum q, deg": "168.5",
        "Joint 2: alpha, deg": "90", "Joint 2: d, mm": "30",
        "Joint 2: theta, deg": "0", "Joint 2: r, mm": "0",
    }  # fmt: skip  # a table
    for label, value in typed.items():
        page.get_by_label(label, exact=True).fill(value)
    seen.photograph("new_table_light")
    sent = json.loads(
        posted(page, "/v1/robots", page.get_by_role("button", name="Use this robot").click).post_data
    )
    first, second = sent["joints"]
    assert (sent["name"], first["r"], second["d"]) == ("typed arm", 0.166, 0.03)
    assert first["theta_offset"] == pytest.approx(-math.pi)
    assert second["alpha"] == pytest.approx(math.pi / 2)
    assert first["limits"]["position"] == pytest.approx([math.radians(-168.5), math.radians(168.5)])
    page.locator(".chosen", has_text="typed arm").wait_for()
    assert seen.barriers() == []


def test_numbers_are_read_as_people_write_them_and_written_as_they_read_them(look, service):
    page = look(service).open("/new")
    read = """async (texts) => {
      const { readNumber } = await import("/static/base/controls.js");
      return texts.map((text) => Number.isNaN(readNumber(text)) ? null : readNumber(text));
    }"""
    texts = ["1.5", "1,5", "-pi/2", "3*pi/4", "π", "2e-3", f"{MINUS}90", "", "abc", "1.2.3", "pi/x"]
    expected = [1.5, 1.5, -math.pi / 2, 0.75 * math.pi, math.pi, 2e-3, -90, None, None, None, None]
    assert page.evaluate(read, texts) == pytest.approx(expected)
    write = """async (values) => {
      const { relative } = await import("/static/base/words.js");
      return values.map((value) => relative(value).replaceAll("\\u00a0", " "));
    }"""
    values = [0, 4e-16, 0.25, 3.14159, 2.07e9, -0.001, -5e4, None]
    shown = ["0 %", "< 0.1 %", "0.25 %", "3.14 %", "> 1000 %", f"> {MINUS}0.1 %", f"< {MINUS}1000 %", "–"]  # noqa: RUF001  (as it is shown)
    assert page.evaluate(write, values) == shown


def test_an_estimate_is_shown_to_the_place_of_its_deviation(look, service):
    write = """async (pairs) => {
      const { measured } = await import("/static/base/words.js");
      return pairs.map(([value, deviation]) => measured(value, deviation));
    }"""
    shown = {
        (0.12344, 0.00678): "0.1234 ± 0.0068",
        (1234.2, 95): "1234 ± 95",
        (-1.234e-5, 2.5e-7): f"({MINUS}1.234 ± 0.025)e{MINUS}5",
        (3.2e-5, 0.02): "0.000 ± 0.020",
        (12, 0.0996): "12.00 ± 0.10",
        (2.5e6, 1e5): "(2.50 ± 0.10)e6",
        (-2.5, None): f"{MINUS}2.5",
        (0, 0): "0",
        (None, 0.1): "–",  # noqa: RUF001  (as it is shown)
    }
    assert look(service).open("/new").evaluate(write, list(shown)) == list(shown.values())


def test_a_cell_that_is_no_number_is_named_and_one_that_is_refused_is_marked(look, service):
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.get_by_role("radio", name="DH table").check()
    cell = page.get_by_label("Joint 2: d, m", exact=True)
    cell.fill("wide")
    page.get_by_text("“wide” is not a number.").wait_for()
    cell.fill("0.2")
    page.get_by_label("Joint 3: minimum q, deg", exact=True).fill("10")
    page.get_by_label("Joint 3: maximum q, deg", exact=True).fill("-10")
    page.get_by_role("button", name="Use this robot").click()
    page.get_by_role("alert").get_by_text("lower limit at or above the upper one").first.wait_for()
    assert page.evaluate("document.activeElement.getAttribute('aria-label')").startswith("Joint 3: minimum q")


def test_a_table_that_is_changed_has_to_be_taken_again(look, service):
    page = look(service).open("/new")
    page.get_by_role("radio", name="DH table").check()
    page.get_by_label("Name", exact=True).fill("edited arm")
    page.get_by_role("button", name="Use this robot").click()
    page.locator(".chosen", has_text="edited arm").wait_for()
    assert page.get_by_text("Missing: robot").count() == 0
    for written in ("0.7", "1/0"):
        page.get_by_label("Joint 2: d, m", exact=True).fill(written)
        page.get_by_text("Missing: robot").wait_for()
        assert page.locator(".chosen").count() == 0


def test_a_urdf_is_read_and_drawn(look, service, tmp_path):
    from veritorque.app.schemas.examples import PENDULUM_URDF

    path = tmp_path / "pendulum.urdf"
    path.write_text(PENDULUM_URDF)
    page = look(service).open("/new")
    page.get_by_role("radio", name="URDF").check()
    page.set_input_files("#robot input[type=file]", path)
    page.locator(".chosen", has_text="pendulum").wait_for()
    assert page.locator(".stage3d .joint").count() == 1


def test_columns_that_say_nothing_are_mapped_in_a_form(look, service, odd_log):
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", odd_log)
    page.get_by_role("heading", name="Map columns").wait_for()
    assert page.get_by_label("Channel of clock_ms").input_value() == "time"
    assert page.get_by_label("Channel of effort_a").input_value() == "torque"
    for column, joint in {"pos_b": 2, "pos_a": 1, "effort_b": 2, "effort_a": 1}.items():
        page.get_by_label(f"Joint of {column}").fill(str(joint))
        page.get_by_label(f"Joint of {column}").press("Tab")
    page.get_by_role("button", name="Apply mapping").click()
    page.get_by_text("Choose the unit of time").wait_for()  # units are never guessed
    for channel, unit in {"time": "ms", "position": "deg", "torque": "mN m"}.items():
        page.get_by_label(f"Unit of {channel}").select_option(unit)
    seen.photograph("new_mapping_light")
    assert seen.barriers() == []
    page.get_by_role("button", name="Apply mapping").click()
    page.get_by_role("article", name="Log odd.csv").wait_for()
    assert "note" in page.locator(".facts").text_content()
    page.locator(".plot").nth(3).wait_for()
    summary = page.get_by_role("img", name="Plot of Torque of joint 1").get_attribute("aria-label")
    _, _, torque = columns(seconds=4.0)
    low, high = torque[:, 0].min(), torque[:, 0].max()
    assert f"from {low:.4g} to {high:.4g}".replace("-", MINUS) in summary


def test_the_mapping_that_names_below_title_lines_suggest_is_applied_by_one_click(look, service, tmp_path):
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    time, position, torque = columns(seconds=4.0)
    rows = [";".join(map(str, row)) for row in np.column_stack([1e3 * time, position, torque])]
    names = "Zeit [ms];Istwinkel_A1 [rad];Istwinkel_A2 [rad];Istmoment_A1 [Nm];Istmoment_A2 [Nm]"
    path = tmp_path / "messung.csv"
    path.write_text("\n".join(["Messung 12;;", "Datum: 27.11.2026;;", names, *rows]), encoding="utf-8")
    page.set_input_files("#log input[type=file]", path)
    page.get_by_role("button", name="Apply suggested mapping").wait_for()
    assert page.get_by_label("Channel of Istmoment_A1 [Nm]").input_value() == "torque"
    assert page.get_by_label("Channel of Istwinkel_A1 [rad]").input_value() == "position"
    assert seen.barriers() == []
    page.get_by_role("button", name="Apply suggested mapping").click()
    page.get_by_role("article", name="Log messung.csv").wait_for()


def test_joints_that_differ_have_a_unit_each(look, service, odd_log):
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", odd_log)
    page.get_by_label("Channel of clock_ms").select_option("time")
    for channel, unit in {"time": "ms", "position": "each", "torque": "mN m"}.items():
        page.get_by_label(f"Unit of {channel}", exact=True).select_option(unit)
    page.get_by_label("Unit of pos_a").focus()
    page.get_by_label("Unit of pos_a").select_option("counts")
    assert page.evaluate("document.activeElement.getAttribute('aria-label')") == "Unit of pos_a"
    again = page.get_by_role("button", name="Apply mapping")
    again.click()
    page.get_by_text("Choose the unit of pos_b").wait_for()
    page.get_by_label("Unit of pos_b").select_option("deg")
    again.click()
    page.get_by_text("Enter the value of one count of pos_a").wait_for()
    page.get_by_label("One count of pos_a, in rad or m").fill("pi/180")
    assert seen.barriers() == []
    again.click()
    page.get_by_role("article", name="Log odd.csv").wait_for()
    page.locator(".plot").nth(3).wait_for()
    _, position, _ = columns(seconds=4.0)
    for joint, values in ((1, position[:, 1]), (2, position[:, 0])):
        summary = page.get_by_role("img", name=f"Plot of Position of joint {joint}").get_attribute(
            "aria-label"
        )
        low, high = (f"{value:.4g}".replace("-", MINUS) for value in (values.min(), values.max()))
        assert f"from {low} to {high}" in summary


def test_currents_are_offered_as_such_with_what_makes_torques_of_them(look, service, tmp_path):
    path = tmp_path / "amperes.csv"
    path.write_bytes(csv_log(seconds=4.0).replace(b"time,q_1,q_2,tau_1,tau_2", b"time,q_1,q_2,i_1,i_2"))
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new?robot=yumi-left")
    page.set_input_files("#log input[type=file]", path)
    page.get_by_text("torque constant (N m/A) times gear ratio").wait_for()
    assert [page.get_by_label(f"Channel of i_{joint}").input_value() for joint in (1, 2)] == ["current"] * 2
    for channel, unit in {"time": "s", "position": "rad", "current": "A"}.items():
        page.get_by_label(f"Unit of {channel}").select_option(unit)
    page.get_by_role("button", name="Apply mapping").click()
    page.get_by_role("article", name="Log amperes.csv").wait_for()
    page.get_by_role("radio", name="DH table").check()
    page.get_by_role("button", name="Remove joint 3").click()
    page.get_by_role("button", name="Use this robot").click()
    page.get_by_text("has no drive gains").wait_for()
    assert page.get_by_role("button", name="Start").is_disabled()


def test_values_that_are_missing_are_named_with_column_and_row_before_any_mapping(look, service, tmp_path):
    rows = csv_log(seconds=4.0).split(b"\n")
    for number in range(8, 8 + 2 * len(rows) // 3):
        cells = rows[number].split(b",")
        rows[number] = b",".join([cells[0], b"nan", *cells[2:]])
    path = tmp_path / "missing.csv"
    path.write_bytes(b"\n".join(rows))
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", path)
    alert = page.get_by_role("alert")
    alert.get_by_text("The column 'q_1' holds").wait_for()
    alert.get_by_text("the first in row 8").wait_for()
    form = page.get_by_role("heading", name="Map columns")
    assert not form.is_visible()
    page.get_by_text("Change the column mapping").click()
    form.wait_for()


def test_the_form_numbers_the_joints_in_the_order_that_is_suggested(look, service, tmp_path):
    time, position, torque = columns(seconds=4.0)
    path = tmp_path / "named.csv"
    names = "time,elbow_pos,shoulder_pos,elbow_torque,shoulder_torque"
    table = np.column_stack([time, position, torque])
    np.savetxt(path, table, delimiter=",", header=names, comments="")
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", path)
    page.get_by_role("button", name="Apply suggested mapping").wait_for()
    for column, joint in {"shoulder_pos": "1", "elbow_pos": "2", "elbow_torque": "2"}.items():
        assert page.get_by_label(f"Joint of {column}").input_value() == joint


def test_the_suggestion_has_the_units_of_the_joints_of_the_robot_that_is_chosen(look, service, tmp_path):
    """Whether it is chosen before the log is refused or after."""
    time, position, torque = columns(seconds=4.0)
    path = tmp_path / "named.csv"
    table = np.column_stack([time, position, torque])
    np.savetxt(path, table, delimiter=",", header="time,pos_1,pos_2,eff_1,eff_2", comments="")
    row = {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    robot = {"name": "turn and slide", "joints": [row, {**row, "type": "prismatic", "alpha": 1.5}]}
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    made = page.evaluate(
        """async (robot) => {
          const headers = { "content-type": "application/json" };
          const asked = { method: "POST", headers, body: JSON.stringify(robot) };
          return (await (await fetch("/v1/robots", asked)).json()).id;
        }""",
        robot,
    )
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", path)
    offered = page.get_by_role("group", name="Suggested mapping")
    offered.get_by_role("cell", name="rad", exact=True).wait_for()
    page.get_by_label("Robot", exact=True).select_option(made)
    offered.get_by_role("cell", name="rad, m", exact=True).wait_for()
    page = seen.open(f"/new?robot={made}")
    page.get_by_text("2 joints, 1 prismatic").first.wait_for()
    page.set_input_files("#log input[type=file]", path)
    offered = page.get_by_role("group", name="Suggested mapping")
    offered.get_by_role("cell", name="rad, m", exact=True).wait_for()
    asked = posted(page, "/v1/logs", page.get_by_role("button", name="Apply suggested mapping").click)
    (text,) = parse_qs(urlsplit(asked.url).query)["mapping"]
    mapping = json.loads(text)
    assert (mapping["position"]["unit"], mapping["torque"]["unit"]) == (["rad", "m"], ["N m", "N"])
    page.get_by_role("article", name="Log named.csv").wait_for()


def test_channels_of_a_motor_are_read_with_the_gear_that_is_entered_for_each_joint(look, service, tmp_path):
    gears = np.array([50.0, 80.0])
    time, position, torque = columns(seconds=4.0)
    table = np.column_stack([time, position * gears, torque / gears])
    names = "t,motor_pos_1,motor_pos_2,motor_torque_1,motor_torque_2"
    path = tmp_path / "motor.csv"
    np.savetxt(path, table, delimiter=",", header=names, comments="")
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", path)
    page.get_by_role("alert").get_by_text("Check the mapping that is suggested below").wait_for()
    page.get_by_text("The factors are in no log").wait_for()
    for channel, unit in {"time": "s", "position": "rad", "torque": "N m"}.items():
        page.get_by_label(f"Unit of {channel}").select_option(unit)
    apply = page.get_by_role("button", name="Apply mapping")
    page.get_by_label("Factor on position").fill("1/50")
    apply.click()
    page.get_by_text("Enter the factor of torque").wait_for()
    page.get_by_label("Factor on position").fill("1/50, 1/80")
    page.get_by_label("Factor on torque").fill("50 80")
    assert seen.barriers() == []
    apply.click()
    page.get_by_role("article", name="Log motor.csv").wait_for()
    page.locator(".plot").nth(3).wait_for()
    summary = page.get_by_role("img", name="Plot of Torque of joint 2").get_attribute("aria-label")
    low, high = torque[:, 1].min(), torque[:, 1].max()
    assert f"from {low:.4g} to {high:.4g}".replace("-", MINUS) in summary


def test_a_gap_is_listed_and_marked_where_it_is(look, service, holed_log):
    seen = look(service)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", holed_log)
    page.locator(".defects").get_by_text("gap", exact=True).wait_for()
    page.locator(".plot").nth(3).wait_for()
    seen.photograph("new_defects_light")
    amber = """(canvas) => {
      const { width, height } = canvas;
      const row = canvas.getContext("2d").getImageData(0, Math.round(height * 0.2), width, 1).data;
      const columns = [];
      for (let x = 0; x < width; x += 1) {
        const [red, , blue, cover] = row.slice(4 * x, 4 * x + 4);
        if (cover > 20 && red > 200 && blue < 60) columns.push(x / width);
      }
      return columns;
    }"""
    marked = page.locator(".plot canvas").first.evaluate(amber)
    # The log lasts from 0 to 8 s and is silent from 3 to 4 s; the plot begins right of its axis.
    assert marked
    assert 0.4 < min(marked) < max(marked) < 0.65


def test_a_log_of_another_number_of_joints_cannot_be_started_with(look, service, holed_log):
    page = look(service).open("/new?robot=yumi-left")
    page.set_input_files("#log input[type=file]", holed_log)
    page.get_by_text("holed.csv has 2 joints, yumi-left has 7.").wait_for()
    assert page.get_by_role("button", name="Start").is_disabled()
    page.get_by_role("button", name="Remove holed.csv").click()
    page.get_by_text("Missing: log.").wait_for()


def test_a_log_that_is_mapped_otherwise_takes_the_place_of_what_it_was(look, service, tmp_path):
    path = tmp_path / "plain.csv"
    path.write_bytes(csv_log(seconds=4.0))
    page = look(service).open("/new")
    page.set_input_files("#log input[type=file]", path)
    logs = page.get_by_role("article", name="Log plain.csv")
    logs.get_by_role("button", name="Change column mapping").click()
    for channel, unit in {"time": "s", "position": "deg", "torque": "N m"}.items():
        page.get_by_label(f"Unit of {channel}").select_option(unit)
    page.get_by_label("Joint of tau_2").fill("1")
    page.get_by_label("Joint of tau_2").press("Tab")
    page.get_by_role("button", name="Apply mapping").click()
    page.get_by_text("Number the joints of torque from 1 to 2, each once.").wait_for()
    page.get_by_label("Joint of tau_2").fill("2")
    page.get_by_label("Joint of tau_2").press("Tab")
    page.get_by_role("button", name="Apply mapping").click()
    page.get_by_role("heading", name="Map columns").wait_for(state="detached")
    assert logs.count() == 1


def test_a_mapping_that_is_refused_stays_to_be_corrected(look, service, odd_log):
    seen = look(service)
    seen.statuses.add(422)
    page = seen.open("/new")
    page.set_input_files("#log input[type=file]", odd_log)
    page.get_by_label("Channel of clock_ms").select_option("")
    for channel, unit in {"position": "deg", "torque": "mN m"}.items():
        page.get_by_label(f"Unit of {channel}").select_option(unit)
    page.get_by_role("button", name="Apply mapping").click()
    page.get_by_text("Choose a time column, or enter the rate.").wait_for()
    page.get_by_label("Rate, Hz").fill("-1")
    with page.expect_response("**/v1/logs?*") as refused:
        page.get_by_role("button", name="Apply mapping").click()
    assert refused.value.status == 422
    page.get_by_role("alert").wait_for()
    assert page.get_by_label("Rate, Hz").input_value() == "-1"
    assert page.get_by_label("Unit of torque").input_value() == "mN m"


def test_a_log_with_the_longest_name_of_a_file_is_taken(look, service, tmp_path):
    path = tmp_path / f"{'l' * 251}.csv"
    path.write_bytes(csv_log(seconds=4.0))
    page = look(service, width=390, height=800).open("/new")
    page.set_input_files("#log input[type=file]", path)
    page.get_by_role("article", name="Log lll").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_a_plot_zooms_by_keys_with_its_neighbours_and_comes_back(look, service, holed_log):
    page = look(service).open("/new")
    page.set_input_files("#log input[type=file]", holed_log)
    page.locator(".plot").nth(3).wait_for()
    whole = page.get_by_role("button", name="Whole range")
    assert whole.count() == 0
    page.locator(".plot .canvas").first.focus()
    page.keyboard.press("+")
    page.wait_for_function("document.querySelectorAll('.plot .tools button:not([hidden])').length === 8")
    assert whole.count() == 4
    page.keyboard.press("Escape")
    page.wait_for_function("document.querySelectorAll('.plot .tools button:not([hidden])').length === 4")
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save Position of joint 1 as CSV").click()
    text = saved.value.path().read_text()
    assert text.startswith("time [s],position [rad]\n")
    assert len(text.splitlines()) <= 4001


def test_a_link_to_a_robot_that_is_not_there_says_so(look, service):
    page = look(service).open("/new?robot=nobody")
    page.get_by_text("There is no robot nobody: choose another one.").wait_for()


def test_coupled_motors_are_typed_in_the_table_and_for_a_copy_of_a_known_robot(look, service):
    seen = look(service)
    page = seen.open("/new?robot=yumi-left")
    page.get_by_text("Add coupled motors").click()
    page.get_by_role("button", name="Add a coupled motor").click()
    page.get_by_label("Motor 1: joints").fill("6, 9")
    page.get_by_role("button", name="Use a copy with these motors").click()
    page.get_by_text("Motor 1 names a joint that is none of the 7 joints.").wait_for()
    page.get_by_label("Motor 1: joints").fill("6, 7")
    page.get_by_label("Motor 1: weights").fill("1 -0,5")
    seen.photograph("new_couplings_light")
    assert seen.barriers() == []
    copied = posted(page, "/v1/robots", page.get_by_role("button", name="Use a copy with these motors").click)
    (coupling,) = json.loads(copied.post_data)["couplings"]
    assert (coupling["joints"], coupling["weights"]) == ([6, 7], [1.0, -0.5])
    page.locator(".chosen", has_text=f"motor 1: q6 {MINUS} 0.5 q7").wait_for()
    page.get_by_role("radio", name="DH table").check()
    page.get_by_label("Start from").wait_for()
    page.get_by_text("Coupled motors", exact=True).click()
    page.get_by_role("button", name="Add a coupled motor").click()
    page.get_by_text("Motor 1 needs at least two different joints.").wait_for()
    page.get_by_label("Motor 1: joints").fill("2 3")
    typed = posted(page, "/v1/robots", page.get_by_role("button", name="Use this robot").click)
    (coupling,) = json.loads(typed.post_data)["couplings"]
    assert (coupling["joints"], coupling["weights"]) == ([2, 3], [1.0, 1.0])


def test_a_coupling_that_was_found_is_applied_by_a_click(look, service):
    seen = look(service)
    seen.statuses.add(404)  # no such study is stored
    page = seen.open("/new")
    page.route("**/v1/jobs", lambda route: route.fulfill(status=202, json={"id": "again"}))
    robot = page.evaluate("async () => (await (await fetch('/v1/robots/yumi-left')).json()).description")
    robot["couplings"] = [{"name": "joints 6 and 7", "number": 7, "joints": [6, 7], "weights": [1.0, 1.0]}]
    page.evaluate(
        """async (robot) => {
          const { showFindings } = await import("/static/result/findings.js");
          const report = new DOMParser().parseFromString("<main></main>", "text/html");
          const repairs = [{ mends: "robot", what: "One coupling" }, { mends: "log", what: "not this" }];
          const job = { kind: "diagnose", robot: "yumi-left", logs: ["log-1"], options: { reference: null } };
          const diagnosis = { repairs, repaired_robot: robot };
          showFindings(document.getElementById("main"), { job, document: { diagnosis }, report });
        }""",
        robot,
    )
    assert page.get_by_text("not this").count() == 0
    apply = page.get_by_role("button", name="Apply and start again")
    with page.expect_request(lambda asked: asked.url.endswith("/v1/robots")) as told:
        job = json.loads(posted(page, "/v1/jobs", apply.click).post_data)
    assert json.loads(told.value.post_data)["couplings"] == robot["couplings"]
    assert (job["kind"], job["logs"], job["robot"] != "yumi-left") == ("diagnose", ["log-1"], True)
    page.wait_for_url("**/studies/again")
