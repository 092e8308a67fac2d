"""Fit the confidence of findings on one set of seeds, check it on another, and write it for the code to read.

Run ``python -m tests.hidden calibrate --fit 41 42 --check 43 --cases 100 --write``. Every drawn log is
diagnosed once, which takes some 15 s of processor time; ``--keep FILE`` stores what was found, so that an
interrupted run goes on where it ended. Each finding gives its predictors and whether it was right: by its
own name, or as one of the causes that it is undecided with.
Sources: Platt, Advances in Large Margin Classifiers (1999), for the logistic form; Brier, Monthly Weather
Review 78 (1950); DeGroot & Fienberg, The Statistician 32 (1983), for reliability.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from sklearn.linear_model import LogisticRegression

from tests.hidden.plan import Order, drawn, orders
from tests.hidden.score import score
from tests.plant.cases import ImpossibleError
from veritorque.core.diagnosis.checks.confidence import CALIBRATION, Calibration, coefficients, probability
from veritorque.core.document.diagnosis import diagnosis_document
from veritorque.core.study import IdentifyRequest, diagnose_in_full

BINS = (0.0, 0.5, 0.8, 0.9, 0.95, 1.0)
"""Edges of the reliability table."""


@dataclass(frozen=True)
class Sample:
    """Hold the predictors of one finding and whether it was right."""

    predictors: tuple[float, ...]
    right: bool


def main(arguments: Sequence[str]) -> int:
    """Fit, check, print, and write if so asked."""
    asked = _arguments(arguments)
    fitted, checked = (_samples(seeds, asked.cases, asked.keep) for seeds in (asked.fit, asked.check))
    if len({sample.right for sample in fitted}) < 2:
        sys.stdout.write(f"{len(fitted)} findings were all right or all wrong: no model fits; ask for more\n")
        return 1
    found = fit(fitted)
    provenance = {
        "fitted_on": {"seeds": asked.fit, "cases_per_seed": asked.cases, "findings": len(fitted)},
        "checked_on": {"seeds": asked.check, "cases_per_seed": asked.cases, "findings": len(checked)},
        "brier": round(brier(found, checked), 4),
        "reliability": reliability(found, checked),
        "command": "python -m tests.hidden calibrate",
    }
    text = json.dumps(coefficients(found) | {"provenance": provenance}, indent=2) + "\n"
    sys.stdout.write(f"before: Brier {brier(Calibration.read(), checked):.4f} on the checked seeds\n{text}")
    if asked.write and against(found):
        sys.stdout.write(f"not written: {', '.join(against(found))} would count against a finding\n")
        return 1
    if asked.write:
        CALIBRATION.write_text(text, encoding="utf-8")
    return 0


def against(model: Calibration) -> list[str]:
    """Name the evidence that a model counts against a finding: it was fitted to too few that are wrong."""
    return [name for name, value in coefficients(model).items() if name != "offset" and value < 0.0]


def fit(samples: Sequence[Sample]) -> Calibration:
    """Fit a logistic model to findings that were right or wrong."""
    model = LogisticRegression().fit([one.predictors for one in samples], [one.right for one in samples])
    intercept, slopes = float(model.intercept_[0]), [float(slope) for slope in model.coef_[0]]
    return Calibration(intercept, *slopes)


def brier(model: Calibration, samples: Sequence[Sample]) -> float:
    """Give the mean squared error of the confidence."""
    return float(np.mean([(probability(model, one.predictors) - one.right) ** 2 for one in samples]))


def reliability(model: Calibration, samples: Sequence[Sample]) -> list[dict[str, float]]:
    """Compare, per bin of confidence, its mean with the share of findings that were right."""
    sure = np.array([probability(model, one.predictors) for one in samples])
    right = np.array([one.right for one in samples])
    rows = []
    for low, high in pairwise(BINS):
        inside = (sure >= low) & (sure < high)
        if inside.any():
            mean, share = float(sure[inside].mean()), float(right[inside].mean())
            rows.append(
                {"from": low, "to": high, "findings": int(inside.sum()), "confidence": round(mean, 3)}
                | {"right": round(share, 3)}
            )
    return rows


def _samples(seeds: Sequence[int], cases: int, keep: Path | None) -> list[Sample]:
    listed = [order for seed in seeds for order in orders(seed, cases)]
    found = {} if keep is None or not keep.exists() else _read(keep)
    missing = [order for order in listed if order.seed not in found]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for order, samples in zip(missing, pool.map(judged, missing), strict=True):
            found[order.seed] = samples
            if keep is not None:
                with keep.open("a", encoding="utf-8") as file:
                    file.write(json.dumps([order.seed, [asdict(sample) for sample in samples]]) + "\n")
    return [sample for order in listed for sample in found[order.seed]]


def _read(keep: Path) -> dict[int, list[Sample]]:
    lines = [json.loads(line) for line in keep.read_text(encoding="utf-8").splitlines()]
    return {
        seed: [Sample(tuple(sample["predictors"]), sample["right"]) for sample in samples]
        for seed, samples in lines
    }


def judged(order: Order) -> list[Sample]:
    """Diagnose one drawn log, and judge its findings; sample checks bring their own p-value."""
    try:
        case = drawn(order)
    except ImpossibleError:
        return []
    request = IdentifyRequest(case.believed, (case.log,), {"bootstrap": {"draws": 0}})
    found = diagnose_in_full(request)
    answer = diagnosis_document(found, version="", options={})["diagnosis"]
    assert isinstance(answer, dict)
    scored = score(answer, case.truth, kind=order.kind, noise=case.noise, seed=order.seed)
    pairs = zip(found.diagnosis.findings, scored.confidences, strict=True)
    return [
        Sample(finding.predictors, right) for finding, (_, right) in pairs if finding.predictors is not None
    ]


def _arguments(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.hidden calibrate", description=__doc__)
    parser.add_argument("--fit", type=int, nargs="+", required=True, help="seeds that the model is fitted on")
    parser.add_argument("--check", type=int, nargs="+", required=True, help="seeds that it is checked on")
    parser.add_argument("--cases", type=int, default=100, help="logs per seed")
    parser.add_argument("--keep", type=Path, help="file of findings by seed, which is read and continued")
    parser.add_argument("--write", action="store_true", help="write the file that the code reads")
    return parser.parse_args(arguments)
