"""The names that recorders use lead to a mapping that can be pasted, with the unit that a name says."""

import json

import numpy as np
import pytest

from tests.core.log.writers import swing, write_csv
from veritorque.core.errors import LogError
from veritorque.core.log.check import check_log
from veritorque.core.log.columns.suggestion import UNKNOWN
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
DEG = 180.0 / np.pi


def recorded(time, *names, time_scale=1.0, scales=()):
    """Name the columns q_1, q_2, tau_1, tau_2 as a recorder does, in its units."""
    scales = dict(enumerate(scales))
    table = {time: COLUMNS["time"] * time_scale}
    for index, (name, values) in enumerate(zip(names, list(COLUMNS.values())[1:], strict=True)):
        table[name] = values * scales.get(index, 1.0)
    return table


RECORDERS = {
    "names of joints, pos and eff": recorded("t", "shoulder_pos", "elbow_pos", "shoulder_eff", "elbow_eff"),
    "names of joints, before": recorded("time", "pos_hip", "pos_knee", "torque_hip", "torque_knee"),
    "units alone": recorded("t(s)", "jnt1(rad)", "jnt2(rad)", "mot1(Nm)", "mot2(Nm)"),
    "plural": recorded("stamp", "positions_1", "positions_2", "efforts_1", "efforts_2"),
    "JointN_Pos": recorded("Time", "Joint1_Pos", "Joint2_Pos", "Joint1_Force", "Joint2_Force"),
    "Axis N": recorded("timestamp", "Axis 1 Position", "Axis 2 Position", "Axis 1 Torque", "Axis 2 Torque"),
    "units in brackets": recorded(
        "Time [ms]", "q1 [deg]", "q2 [deg]", "Torque1 [Nm]", "Torque2 [Nm]", time_scale=1e3, scales=(DEG, DEG)
    ),
    "a slide beside a revolute joint": recorded(
        "Zeit [ms]", "Achse1 Winkel [deg]", "Achse2 Weg [mm]", "Achse1 Moment [Nm]", "Achse2 Kraft [N]",
        time_scale=1e3, scales=(DEG, 1e3),
    ),
    "units after a sign": recorded(
        "time_us", "pos_deg_1", "pos_deg_2", "tau_mNm_1", "tau_mNm_2", time_scale=1e6,
        scales=(DEG, DEG, 1e3, 1e3),
    ),
    "rostopic": recorded(
        "%time", "field.position0", "field.position1", "field.effort0", "field.effort1", time_scale=1e9
    )
    | {"field.header.seq": np.arange(len(COLUMNS["time"]))},
    "KUKA FRI": recorded("time", "mp1", "mp2", "mt1", "mt2") | {"ip1": COLUMNS["q_1"], "ip2": COLUMNS["q_2"]},
    "Kinova": recorded(
        "timestamp", "actuators[0].position", "actuators[1].position", "actuators[0].torque",
        "actuators[1].torque", scales=(DEG, DEG),
    ),
    "German": recorded(
        "Zeit [ms]", "Winkel Achse 1 (°)", "Winkel Achse 2 (°)", "Drehmoment Achse 1 (Nm)",
        "Drehmoment Achse 2 (Nm)", time_scale=1e3, scales=(DEG, DEG),
    ),
    "German compounds": recorded(
        "Zeitstempel [s]", "Istlage_A1", "Istlage_A2", "Istmoment_A1", "Istmoment_A2"
    )
    | {"Solllage_A1": COLUMNS["q_1"], "Solllage_A2": COLUMNS["q_2"]},
    "MATLAB": recorded("t", "q(1)", "q(2)", "tau(1)", "tau(2)"),
    "CAPITALS": recorded("TIME", "POS1", "POS2", "TRQ1", "TRQ2"),
}  # fmt: skip  # a table


@pytest.mark.parametrize("recorder", RECORDERS)
def test_the_mapping_that_is_suggested_for_a_recorder_reads_its_log_in_si(recorder, tmp_path):
    path = write_csv(tmp_path / "log.csv", RECORDERS[recorder])
    suggested = check_log(path).suggestion
    assert suggested is not None
    rows = whole_rows(read_log(path, mapping=suggested))
    np.testing.assert_allclose(rows.time, COLUMNS["time"], atol=1e-9)
    for joint in (1, 2):
        np.testing.assert_allclose(rows.position[:, joint - 1], COLUMNS[f"q_{joint}"], atol=1e-9)
        np.testing.assert_allclose(rows.torque[:, joint - 1], COLUMNS[f"tau_{joint}"], atol=1e-9)


@pytest.mark.parametrize(
    ("names", "channel", "unit"),
    [
        (("q1(deg)", "q2(deg)", "torque1(%)", "torque2(%)"), "torque", "%"),
        (("pos1", "pos2", "torque_pct_1", "torque_pct_2"), "torque", "%"),
        (("pos1", "pos2", "current1 [%]", "current2 [%]"), "current", "%"),
        (("pos1", "pos2", "torque1_counts", "torque2_counts"), "torque", "counts"),
    ],
)
def test_a_unit_that_needs_a_scale_is_suggested_with_the_scale_left_open(names, channel, unit, tmp_path):
    suggested = check_log(write_csv(tmp_path / "log.csv", recorded("time", *names))).suggestion
    assert suggested[channel] == {"columns": list(names[2:]), "unit": unit, "scale": UNKNOWN}


@pytest.mark.parametrize(
    ("names", "unit"), [(("q1", "q2", "i1_mA", "i2_mA"), "mA"), (("q1", "q2", "I1 [A]", "I2 [A]"), "A")]
)
def test_a_unit_of_a_current_is_read_off_its_name(names, unit, tmp_path):
    suggested = check_log(write_csv(tmp_path / "log.csv", recorded("time", *names))).suggestion
    assert suggested["current"]["unit"] == unit


@pytest.mark.parametrize("arms", [("left", "right"), ("Robot A", "Robot B")])
def test_every_arm_of_a_file_has_a_mapping_of_its_own(arms, tmp_path):
    table = {"time": COLUMNS["time"]}
    for number, arm in enumerate(arms):
        for name, values in list(COLUMNS.items())[1:]:
            table[f"{arm}_{name}"] = values + number
    path = write_csv(tmp_path / "log.csv", table)
    seen = check_log(path)
    mappings = [seen.suggestion, *seen.other_arms]
    assert len(mappings) == len(arms)
    for number, mapping in enumerate(mappings):
        read = whole_rows(read_log(path, mapping=mapping)).position
        np.testing.assert_allclose(read[:, 0], COLUMNS["q_1"] + number, atol=1e-12)


def test_the_suggestion_for_lists_of_a_data_set_is_whole(tmp_path):
    names = ("observation.state_1", "observation.state_2", "observation.effort_1", "observation.effort_2")
    path = write_csv(tmp_path / "log.csv", recorded("timestamp", *names))
    suggested = check_log(path).suggestion
    assert suggested["profile"] == "lerobot"
    assert read_log(path, mapping=suggested).joints == 2


def test_a_refusal_for_names_offers_the_mapping_that_would_do(tmp_path):
    path = write_csv(tmp_path / "log.csv", RECORDERS["JointN_Pos"])
    with pytest.raises(LogError) as refusal:
        read_log(path)
    (offered,) = refusal.value.evidence["suggested_mappings"]
    assert json.dumps(offered) in refusal.value.remedy
    assert read_log(path, mapping=offered).joints == 2


ALPHABETICAL = ("elbow_joint", "shoulder_lift_joint", "shoulder_pan_joint", "wrist_1_joint", "wrist_2_joint")


@pytest.mark.parametrize(
    "pattern", ["{quantity}.{joint}", "/joint_states/{joint}/{quantity}", "{joint}_{quantity}"]
)
def test_joints_called_by_their_part_are_all_suggested_in_the_order_of_the_arm(pattern, tmp_path):
    """Part of them are numbered as well, which makes no robot of two joints of them."""
    columns = swing(joints=5)
    names = {
        pattern.format(quantity=quantity, joint=joint): columns[f"{prefix}_{number}"]
        for quantity, prefix in (("position", "q"), ("effort", "tau"))
        for number, joint in enumerate(ALPHABETICAL, 1)
    }
    path = write_csv(tmp_path / "log.csv", {"time": columns["time"]} | names)
    order = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint"]
    suggested = check_log(path).suggestion
    for channel, quantity in (("position", "position"), ("torque", "effort")):
        wanted = [pattern.format(quantity=quantity, joint=joint) for joint in order]
        assert suggested[channel]["columns"] == wanted


def test_a_gripper_of_another_name_does_not_join_the_numbered_joints(tmp_path):
    table = recorded("t", "J1_pos", "J2_pos", "J1_torque", "J2_torque")
    table |= {"gripper_pos": COLUMNS["q_1"], "gripper_torque": COLUMNS["tau_1"]}
    suggested = check_log(write_csv(tmp_path / "log.csv", table)).suggestion
    assert suggested["position"]["columns"] == ["J1_pos", "J2_pos"]


@pytest.mark.parametrize("order", ["q tau", "tau q", "q qd tau", "q tau qd"])
def test_columns_without_names_are_told_by_what_they_hold(order, tmp_path):
    columns = swing(joints=3)
    columns |= {f"qd_{j}": np.gradient(columns[f"q_{j}"], columns["time"]) for j in (1, 2, 3)}
    table = [columns["time"], *(columns[f"{prefix}_{j}"] for prefix in order.split() for j in (1, 2, 3))]
    np.savetxt(tmp_path / "log.txt", np.column_stack(table))
    suggested = check_log(tmp_path / "log.txt").suggestion
    log = read_log(tmp_path / "log.txt", mapping=suggested)
    np.testing.assert_allclose(whole_rows(log).position[:, 2], columns["q_3"])
    np.testing.assert_allclose(whole_rows(log).torque[:, 0], columns["tau_1"])
    assert ("velocity" in log.channels) is ("qd" in order)


@pytest.mark.parametrize("width", [1, 2, 3, 5])
def test_columns_without_names_that_fit_no_arm_are_not_guessed(width, tmp_path):
    """No clock, or no equal number of columns for each quantity."""
    random = np.random.default_rng(3)
    np.savetxt(tmp_path / "log.txt", random.standard_normal((300, width + 1)))
    assert check_log(tmp_path / "log.txt").suggestion is None


@pytest.mark.parametrize("names", [("position", "torque"), ("angle [rad]", "torque [Nm]"), ("pos", "effort")])
def test_one_joint_needs_no_number(names, tmp_path):
    table = {"t": COLUMNS["time"], names[0]: COLUMNS["q_1"], names[1]: COLUMNS["tau_1"]}
    path = write_csv(tmp_path / "log.csv", table)
    assert read_log(path, mapping=check_log(path).suggestion).joints == 1


def test_a_clock_of_another_name_is_the_column_that_grows_and_does_not_count(tmp_path):
    table = {"frame": np.arange(3000.0)} | recorded("duration", "pos1", "pos2", "trq1", "trq2")
    suggested = check_log(write_csv(tmp_path / "log.csv", table)).suggestion
    assert suggested["time"] == {"column": "duration", "unit": "s"}


def test_what_is_measured_at_the_motor_leaves_the_gear_open(tmp_path):
    names = ("motor_pos_1", "motor_pos_2", "motor_torque_1", "motor_torque_2")
    suggested = check_log(write_csv(tmp_path / "log.csv", recorded("t", *names, scales=(32, 45)))).suggestion
    assert suggested["position"] == {"columns": list(names[:2]), "unit": "rad", "scale": UNKNOWN}
    assert suggested["torque"] == {"columns": list(names[2:]), "unit": "N m", "scale": UNKNOWN}


@pytest.mark.parametrize("torques", [("tau_1", "tau_2"), ("motor_torque_1", "motor_torque_2")])
def test_what_is_measured_at_the_joint_goes_before_what_is_measured_at_the_motor(torques, tmp_path):
    table = {f"motor_pos_{joint}": 99.0 * COLUMNS[f"q_{joint}"] for joint in (1, 2)}
    table |= recorded("t", "joint_pos_1", "joint_pos_2", *torques)
    suggested = check_log(write_csv(tmp_path / "log.csv", table)).suggestion
    assert suggested["position"] == {"columns": ["joint_pos_1", "joint_pos_2"], "unit": "rad"}
    assert suggested["torque"]["columns"] == list(torques)


@pytest.mark.parametrize(
    ("names", "there", "absent"),
    [
        (("feedback.joints[0]", "feedback.joints[1]"), "positions", "torque or current"),
        (("q_1", "q_2"), "positions", "torque or current"),
        (("torque_ref_1", "torque_ref_2"), "torque or current", "positions"),
    ],
)
def test_half_a_log_is_told_to_be_joined_with_the_other_half(names, there, absent, tmp_path):
    table = {"feedback.time": COLUMNS["time"]} | dict(zip(names, list(COLUMNS.values())[1:3], strict=True))
    path = write_csv(tmp_path / "log.csv", table)
    seen = check_log(path)
    assert seen.refusal.cause == f"the file holds {there}, and no {absent}"
    assert "veritorque logs join" in seen.refusal.remedy
    with pytest.raises(LogError, match="and no"):
        read_log(path)


@pytest.mark.parametrize(
    ("names", "scales", "units"),
    [
        (("pos1", "pos2", "trq1", "trq2"), (1.0, 0.2, 1.0, 1.0), (["rad", "m"], ["N m", "N"])),
        (("pos1", "pos2", "trq1", "trq2"), (DEG, 200.0, 1.0, 1.0), (["deg", "mm"], ["N m", "N"])),
        (("pos1", "pos2", "trq1", "trq2"), (1.0, 0.0, 1.0, 1e-4), (["rad", "m"], ["N m", "N"])),
        (("pos1 [deg]", "pos2 [m]", "trq1", "trq2 [N]"), (DEG, 0.2, 1.0, 1.0), (["deg", "m"], ["N m", "N"])),
    ],
)
def test_a_prismatic_joint_of_the_robot_is_suggested_in_lengths_and_forces(names, scales, units, tmp_path):
    """By its name, its size, or SI where neither tells; and the log is read by it."""
    path = write_csv(tmp_path / "log.csv", recorded("time", *names, scales=scales))
    with pytest.raises(LogError) as refusal:
        read_log(path, prismatic=[2])
    (offered,) = refusal.value.evidence["suggested_mappings"]
    assert (offered["position"]["unit"], offered["torque"]["unit"]) == units
    assert "suggested_if_prismatic" not in refusal.value.evidence
    si = [1.0, {"m": 1.0, "mm": 1e-3}[units[0][1]]]
    rows = whole_rows(read_log(path, mapping=offered))
    np.testing.assert_allclose(rows.position[:, 1], COLUMNS["q_2"] * scales[1] * si[1], atol=1e-9)


def test_velocities_of_a_prismatic_joint_are_metres_per_second_and_currents_stay_amperes(tmp_path):
    names = ("pos1", "pos2", "cur1", "cur2")
    table = recorded("time", *names) | {f"vel{joint}": COLUMNS["q_1"] for joint in (1, 2)}
    with pytest.raises(LogError) as refusal:
        read_log(write_csv(tmp_path / "log.csv", table), prismatic=[1, 2])
    (offered,) = refusal.value.evidence["suggested_mappings"]
    assert {name: offered[name]["unit"] for name in ("position", "velocity", "current")} == {
        "position": "m",
        "velocity": "m/s",
        "current": "A",
    }


def test_where_the_robot_is_not_known_both_kinds_of_joint_are_suggested(tmp_path):
    path = write_csv(tmp_path / "log.csv", recorded("time", "pos1", "pos2", "trq1", "trq2"))
    with pytest.raises(LogError) as refusal:
        read_log(path)
    (turning,) = refusal.value.evidence["suggested_mappings"]
    (sliding,) = refusal.value.evidence["suggested_if_prismatic"]
    assert (turning["position"]["unit"], sliding["position"]["unit"]) == ("rad", "m")
    assert {name: request["columns"] for name, request in turning.items() if name != "time"} == {
        name: request["columns"] for name, request in sliding.items() if name != "time"
    }
    assert check_log(path).suggestion == turning


def test_a_table_without_names_is_not_cut_in_halves_where_a_third_is_the_rate_of_another(tmp_path):
    """Twelve columns may be of six joints or of four; only of four is one quantity another's derivative."""
    columns = swing(joints=4)
    time = columns["time"]
    rates = {f"qd_{joint}": np.gradient(columns[f"q_{joint}"], time) for joint in range(1, 5)}
    values = {"q": columns, "qd": rates, "tau": columns}
    table = [time, *(values[name][f"{name}_{joint}"] for name in values for joint in range(1, 5))]
    np.savetxt(tmp_path / "log.txt", np.column_stack(table), fmt="%.9f")
    suggested = check_log(tmp_path / "log.txt").suggestion
    assert {name: request.get("columns") for name, request in suggested.items() if name != "time"} == {
        "position": [f"column_{place}" for place in range(2, 6)],
        "velocity": [f"column_{place}" for place in range(6, 10)],
        "torque": [f"column_{place}" for place in range(10, 14)],
    }
