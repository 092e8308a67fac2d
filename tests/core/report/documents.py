"""Two small result documents of a two-joint arm, whose second joint slides, with numbers to look for."""


def scores(first=2.0, second=4.0):
    names = ("samples", "rms_torque", "rms_residual", "nrmse_of_range_percent", "nrmse_of_rms_percent")
    rows = ((100, 10.0, first / 10.0, first / 4.0, first), (100, 5.0, second / 20.0, second / 4.0, second))
    return [{"joint": joint} | dict(zip(names, row, strict=True)) for joint, row in enumerate(rows, start=1)]


def parameter(name="ZZR1", **changes):
    return {
        "name": name,
        "unit": "kg m2",
        "joint": 1,
        "value": 0.5,
        "value_ols": 0.6,
        "standard_deviation": 0.01,
        "relative_deviation_percent": 2.0,
        "essential": True,
        "grouping": "ZZ1 + YY2",
    } | changes


def conflict(**changes):
    """Joints 2 and 1 were exchanged; it was noticed and corrected."""
    return {
        "conflict": "channels_swapped",
        "joints": [1, 2],
        "channel": "torque",
        "confidence": 0.97,
        "error_before_percent": 47.12,
        "error_after_percent": 4.83,
        "applied": True,
        "statement": "the torques of joints 1 and 2 are exchanged",
        "remedy": "exchange the channels of joints 1 and 2",
        "correction": {"mapping": {"torque": {"columns": ["tau_2", "tau_1"]}}, "robot": {}},
        "ambiguous_with": [
            {"conflict": "position_sign", "joints": [2], "channel": "position", "why": "it predicts as well"}
        ],
    } | changes


def identified(**changes):
    return {
        "schema_version": "1.0",
        "kind": "identify",
        "robot": {"name": "bench arm", "joints": [{"type": "revolute"}, {"type": "prismatic"}]},
        "logs": [
            {
                "name": "swing.csv",
                "samples": 2400,
                "duration_s": 12.0,
                "rate_hz": 200.0,
                "filter": {"cutoff_hz": 9.5},
            }
        ],
        "provenance": {"version": "0.1.0", "log_sha256": ["abc123"], "options": {"essential": True}},
        "counts": {"standard": 22, "base": 12, "essential": 11},
        "base_parameters": [parameter()],
        "terms": ["rigid_body"],
        "standard_parameters": [
            {"name": "ZZ1", "joint": 1, "unit": "kg m2", "value": 0.4, "identifiable": "in_combination"}
        ],
        "feasibility": {
            "feasible": True,
            "ols_feasible": False,
            "pseudo_inertia_min_eigenvalue": [0.002, 0.001],
            "active_constraints": [],
            "mass_matrix_min_eigenvalue": {"workspace": 0.07, "configurations": 10000},
        },
        "solver": {"status": "optimal", "iterations": 9, "objective": 2.5, "objective_ols": 2.4},
        "fit": scores(1.5, 3.5),
        "fit_total_percent": 2.25,
        "validation": scores(),
        "validation_total_percent": 2.75,
        "condition_number": 40.0,
        "defects": [
            {
                "log": 1,
                "kind": "outliers",
                "channel": "torque",
                "joint": 2,
                "count": 3,
                "intervals": [],
                "statement": "3 samples of torque 2 lie far from their neighbours",
            }
        ],
        "doubts": ["The motion does not excite MX2"],
        "diagnosis": None,
    } | changes


def finding(**changes):
    return {
        "cause": "friction_load_dependent",
        "title": "Load-dependent friction",
        "joints": [1],
        "statement": "Load-dependent friction on joint 1: 0.07 N m per N m",
        "confidence": 0.98,
        "p_value": 1e-9,
        "cure": "term",
        "parameters": [
            {
                "name": "load_coefficient",
                "joint": 1,
                "unit": "1",
                "value": 0.07,
                "standard_deviation": 0.002,
                "relative_deviation_percent": 2.857,
            }
        ],
        "explained_residual_fraction": 0.41,
        "evidence": [{"statement": "Rise of the likelihood", "statistic": "likelihood ratio", "value": 91.5}],
        "ambiguous_with": [alternative("torque_gain", "Torque gain error", "run both directions")],
        "refuted": [alternative("torque_ripple", "Torque ripple", "")],
        "gain": {
            "rms_residual_before": [0.3, 0.2],
            "rms_residual_after": [0.2, 0.2],
            "held_out": True,
            "improvement_percent": [33.3, 0.0],
            "improvement_total_percent": 33.3,
            "interval_95": [20.0, 45.0],
        },
        "curve": curve(),
    } | changes


def alternative(cause, title, experiment):
    why = f"the reason about {cause}"
    return {
        "cause": cause,
        "title": title,
        "joints": [1],
        "statistic": 9.0,
        "why": why,
        "separating_experiment": experiment,
    }


def curve(**changes):
    return {
        "coordinate": "load",
        "unit": "N m",
        "joint": 1,
        "centre": [-1.0, 1.0, -1.0, 1.0],
        "before": [0.2, 0.1, -0.2, -0.1],
        "after": [0.01, 0.0, -0.01, 0.0],
        "model": [0.3, 0.3, -0.3, -0.3],
        "standard_error": [0.01, 0.01, 0.01, 0.01],
        "direction": [-1.0, -1.0, 1.0, 1.0],
    } | changes


def dependence(coordinate, joint, p_value):
    return {
        "coordinate": coordinate,
        "joint": joint,
        "unit": "rad/s",
        "centre": [-1.0, 0.0, 1.0],
        "mean": [0.1, -0.2, 0.1],
        "standard_error": [0.01, 0.01, 0.01],
        "statistic": 50.0,
        "p_value": p_value,
    }


def motion(scale):
    rows = [[0.001 * scale, 0.002 * scale], [0.004 * scale, 0.003 * scale]]
    return {
        "horizons_s": [0.05, 0.2],
        "windows": 60,
        "position_rms": rows,
        "velocity_rms": rows,
        "steady_rms": rows,
    }


def diagnosis(**changes):
    gains = [
        {
            "joint": 1,
            "rms_residual_before": 0.2,
            "rms_residual_after": 0.1,
            "improvement_percent": 50.0,
            "interval_95": [40.0, 60.0],
            "held_out": True,
        },
        {
            "joint": 2,
            "rms_residual_before": 0.2,
            "rms_residual_after": 0.2,
            "improvement_percent": 0.4,
            "interval_95": [-1.0, 2.0],
            "held_out": True,
        },
    ]
    return {
        "verdict": "causes_found",
        "findings": [finding()],
        "not_identifiable": [
            alternative("encoder_offset", "Encoder zero error", "turn the joint's neighbours")
        ],
        "unexplained": {
            "joints": [],
            "predictable_residual_fraction": [0.0, 0.02],
            "interval_95": [[0.0, 0.0], [0.0, 0.05]],
            "at_rest_fraction": [0.1, 0.7],
            "rms_residual": [0.1, 0.2],
            "places": [[], []],
            "noise_floor": [0.1, None],
            "pattern": None,
            "noise_floor_source": ["repeats", "none"],
        },
        "gain": gains,
        "before": {"validation": scores()},
        "after": {
            "validation": scores(1.0, 4.0),
            "base_parameters": [parameter(new=False), parameter("load_coefficient1", unit="1", new=True)],
        },
        "simulation": {
            "held_out": True,
            "before": motion(1.0),
            "after": motion(0.5),
            "improvement_total_percent": [50.0, 50.0],
            "interval_95": [[45.0, 55.0], [-1.0, 80.0]],
        },
        "atlas": [],
        "spectra": [],
        "search": [],
        "band_hz": 20.0,
    } | changes


def diagnosed(**changes):
    found = diagnosis(**changes)
    rows = found["after"]["base_parameters"]
    document = identified(kind="diagnose", diagnosis=found)
    extended = {"name": "extended", "statement": "The extended model: the diagnosis added load_coefficient1"}
    return (
        document | {"model": extended, "plain": identified(bodies=[]), "base_parameters": rows}
        if rows
        else document
    )


def nothing_found():
    after = {"validation": [], "base_parameters": []}
    simulation = {"before": {}, "after": {}}
    return diagnosed(verdict="nothing_found", findings=[], gain=[], after=after, simulation=simulation)


def checked(**changes):
    whole = identified()
    taken = ("schema_version", "robot", "logs", "provenance", "counts", "terms", "fit", "fit_total_percent")
    more = ("validation", "validation_total_percent", "condition_number", "defects")
    return {
        "kind": "check",
        "agreement": "after_correction",
        "conflicts": [conflict()],
        "doubts": ["its conflict", "Motion is short"],
        **{key: whole[key] for key in (*taken, *more)},
        "held_out": [],
        "identifiable": [
            {key: parameter(name)[key] for key in ("name", "joint", "unit", "grouping")}
            | {"relative_deviation_percent": percent, "identifiable": answer}
            for name, percent, answer in (
                ("ZZR1", 2.0, "yes"),
                ("MX2", 40.0, "poorly"),
                ("MY2", None, "needs_motion"),
            )
        ],
        "shown": [
            {
                "cause": "joint_elasticity",
                "title": "Joint elasticity",
                "visible": True,
                "not_on_joints": [2],
                "smallest": [
                    {
                        "joints": [1],
                        "name": "stiffness",
                        "unit": "N m/rad",
                        "bound": "at_most",
                        "value": 1500.0,
                    }
                ],
                "experiment": "motion with large accelerations",
            },
            {
                "cause": "torque_ripple",
                "title": "Torque ripple",
                "visible": False,
                "not_on_joints": [1, 2],
                "smallest": [],
                "experiment": "slow motion over the whole range",
            },
        ],
        "separable": {
            "joint_elasticity": {"torque_ripple": "needs_motion"},
            "torque_ripple": {"joint_elasticity": "needs_motion"},
        },
        "not_separable": [
            {
                "causes": ["joint_elasticity", "torque_ripple"],
                "answer": "needs_motion",
                "joints": [],
                "why": "this motion shows both on no joint together",
                "experiment": "motion with large accelerations",
            }
        ],
    } | changes
