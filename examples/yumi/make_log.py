"""Record logs of a simulated YuMi arm, 30 s at 250 Hz, and write the truth beside them.

One log is of the arm as it is described; in the other it does two things that no standard model has.

The arm is simulated once without noise (`simulate`); sensors are applied afterwards (`measure`), so that a
study can draw as many noise realisations as it likes from one motion. Nothing of the product is imported
here: engine and truth are outside it.

Run ``python -m examples.yumi.make_log`` to write `log.csv`, `truth.json` and `robot.json` again, and with
``--hidden`` to write `hidden_log.csv` and `hidden_truth.json`.
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pinocchio as pin
from scipy.signal import lfilter

from examples.yumi import arm
from examples.yumi.excitation import BASE_PERIOD, DURATION, Excitation, best_of_many
from examples.yumi.hidden import EFFECTS, NOTHING, TWO_EFFECTS, Hidden
from examples.yumi.plant import Plant, pinocchio_model, standard_parameters

STEPS_PER_SAMPLE: Final = 16
"""The simulation and its controller run at 4 kHz, the log at 250 Hz."""

SEED: Final = 2024
NOISE_SEED: Final = 0
HIDDEN_SEED: Final = 2025
HIDDEN_NOISE_SEED: Final = 1

WHITE_NOISE: Final = np.array([0.35, 0.35, 0.12, 0.12, 0.025, 0.011, 0.012])
"""Standard deviation of the torque's white noise, N m."""
COLOURED_NOISE: Final = 0.3 * WHITE_NOISE
"""Standard deviation of the torque's first-order autoregressive noise, N m."""
AUTOREGRESSION: Final = 0.8
"""Its correlation from one sample to the next at 250 Hz."""

BANDWIDTH: Final = 2.0 * np.pi * 8.0
STIFFNESS: Final = np.array([0.10, 0.25, 0.05, 0.08, 0.015, 0.008, 0.006]) * BANDWIDTH**2
DAMPING: Final = 2.0 * STIFFNESS / BANDWIDTH


@dataclass(frozen=True, eq=False)
class SimulatedMotion:
    """Hold what really happened: time in s, the others samples x joints in rad, rad/s, rad/s2 and N m."""

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray
    friction: np.ndarray
    excitation: Excitation


def simulate(
    seed: int = SEED,
    *,
    excitation: Excitation | None = None,
    until: float = DURATION,
    hidden: Hidden = NOTHING,
) -> SimulatedMotion:
    """Search for a motion and let the arm follow it; give every sample at 250 Hz without noise.

    Parameters
    ----------
    seed
        Decides the motion.
    excitation
        A motion found before, which spares the search.
    until
        Time in s after which to stop early.
    hidden
        What the arm does beside what is described.
    """
    model = pinocchio_model()
    motion = excitation or best_of_many(model, seed, WHITE_NOISE)
    step = 1.0 / (arm.RATE_HZ * STEPS_PER_SAMPLE)
    count = round(until / step)
    references = motion.at(step * np.arange(count))
    plant = Plant(model, motion.centre.copy(), step, hidden)
    samples = []
    for index, reference in enumerate(zip(*references, strict=True)):
        torque = control(plant, reference)
        before = plant.position
        now = plant.advance(torque)
        if index % STEPS_PER_SAMPLE == 0:
            samples.append((before, *now, torque, plant.friction))
    time = np.arange(len(samples)) / arm.RATE_HZ
    position, velocity, acceleration, torque, friction = np.array(samples).transpose(1, 0, 2)
    return SimulatedMotion(time, position, velocity, acceleration, torque, friction, motion)


def control(plant: Plant, reference: tuple[np.ndarray, np.ndarray, np.ndarray]) -> np.ndarray:
    """Compute the torque a joint controller commands, N m: rigid-body and friction feed-forward, and PD."""
    wanted, rate, acceleration = reference
    model_torque = pin.rnea(plant.model, plant.data, wanted, rate, acceleration)
    friction = arm.COULOMB * np.tanh(rate / 0.004) + arm.VISCOUS * rate + arm.OFFSET
    feedback = STIFFNESS * (wanted - plant.position) + DAMPING * (rate - plant.midpoint_velocity())
    return np.asarray(model_torque + friction + feedback)


def measure(motion: SimulatedMotion, noise_seed: int = NOISE_SEED) -> dict[str, np.ndarray]:
    """Read the sensors: quantised encoders, torque with noise; give the log's columns by name."""
    generator = np.random.default_rng(noise_seed)
    shape = motion.torque.shape
    white = generator.normal(size=shape)
    innovation = generator.normal(size=shape) * np.sqrt(1.0 - AUTOREGRESSION**2)
    innovation[0] /= np.sqrt(1.0 - AUTOREGRESSION**2)
    coloured = lfilter([1.0], [1.0, -AUTOREGRESSION], innovation, axis=0)
    torque = motion.torque + WHITE_NOISE * white + COLOURED_NOISE * coloured
    position = arm.ENCODER_STEP * np.round(motion.position / arm.ENCODER_STEP)
    columns = {"time": np.round(motion.time, 3)}
    columns |= {f"q_{number}": column for number, column in enumerate(np.round(position, 6).T, start=1)}
    columns |= {f"tau_{number}": column for number, column in enumerate(np.round(torque, 4).T, start=1)}
    return columns


def truth(motion: SimulatedMotion, seed: int, noise_seed: int) -> dict[str, object]:
    """Describe everything that the log was made from."""
    span = np.ptp(motion.torque, axis=0)
    noise = np.hypot(WHITE_NOISE, COLOURED_NOISE)
    return {
        "robot": "yumi-left",
        "engine": f"pinocchio {pin.__version__}, leapfrog at {arm.RATE_HZ * STEPS_PER_SAMPLE:.0f} Hz",
        "seed": seed,
        "noise_seed": noise_seed,
        "standard_parameters": standard_parameters(pinocchio_model()),
        "links": arm.link_bodies(),
        "sensors": {
            "rate_hz": arm.RATE_HZ,
            "encoder_step_rad": arm.ENCODER_STEP,
            "torque_white_noise": WHITE_NOISE.tolist(),
            "torque_coloured_noise": COLOURED_NOISE.tolist(),
            "torque_autoregression": AUTOREGRESSION,
            "torque_range": np.round(span, 3).tolist(),
            "noise_of_range_percent": np.round(100 * noise / span, 2).tolist(),
        },
        "motion": {
            "duration": DURATION,
            "base_period": BASE_PERIOD,
            "centre": motion.excitation.centre.tolist(),
            "sine": motion.excitation.sine.tolist(),
            "cosine": motion.excitation.cosine.tolist(),
        },
        "units": "SI: kg, m, rad, s, N m; XX..ZZ about the link frame's origin, XY = -integral xy dm",
    }


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> None:
    """Write the columns with the digits their sensors have: 1 ms, 1e-6 rad, 1e-4 N m."""
    digits = {"time": "%.3f", "q": "%.6f", "tau": "%.4f"}
    formats = [digits[name.split("_")[0]] for name in columns]
    table = np.column_stack(list(columns.values())) + 0.0
    np.savetxt(path, table, fmt=formats, delimiter=",", header=",".join(columns), comments="")


def write_json(path: Path, document: dict[str, object]) -> None:
    """Write a document for people to read."""
    path.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    """Write the log, the truth and the robot's description."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seed", type=int, help="decides the motion")
    parser.add_argument("--noise-seed", type=int, help="decides the torque noise")
    parser.add_argument("--hidden", action="store_true", help="hide two effects, and write the second log")
    parser.add_argument("--directory", type=Path, default=arm.HERE, help="where the files go")
    arguments = parser.parse_args()
    usual = (HIDDEN_SEED, HIDDEN_NOISE_SEED) if arguments.hidden else (SEED, NOISE_SEED)
    seed = usual[0] if arguments.seed is None else arguments.seed
    noise_seed = usual[1] if arguments.noise_seed is None else arguments.noise_seed
    motion = simulate(seed, hidden=TWO_EFFECTS if arguments.hidden else NOTHING)
    prefix = "hidden_" if arguments.hidden else ""
    told = truth(motion, seed, noise_seed)
    told |= {"hidden": EFFECTS} if arguments.hidden else {}
    write_csv(arguments.directory / f"{prefix}log.csv", measure(motion, noise_seed))
    write_json(arguments.directory / f"{prefix}truth.json", told)
    if not arguments.hidden:
        write_json(arguments.directory / "robot.json", arm.robot_description())


if __name__ == "__main__":
    main()
