"""Candidate cause: contact of the last link with the environment for a while, once or several times."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...dynamics.term import Term
from ...dynamics.terms.external_contact import WRENCH, Contact, Span, contact_jacobian
from ..dataset.dataset import Dataset
from ..dataset.spikes import has_spike
from ..regression.innovation_covariance import fitted_rows, inverse_covariances, torque_residual
from ..thresholds.causes import ADMISSIBLE, EVENTS
from .protocol import FittedCause, Quantity, Scalars, SearchTraits, Setting, Site, number_text
from .shared.events import find_events
from .shared.own_joint import OwnJointCause, end_links


def _spans(scalars: Scalars) -> tuple[Span, ...]:
    count = len(scalars) // 2
    return tuple((scalars[f"start_{number}"], scalars[f"end_{number}"]) for number in range(1, count + 1))


def _spans_tried(grid: Sequence[Scalars], scalars: Scalars) -> float:
    """Count what was searched: every span of time, for every contact."""
    del grid
    return float(EVENTS.spans) ** len(_spans(scalars))


@dataclass(frozen=True)
class ExternalContact(OwnJointCause):
    """Candidate cause: contact forces on the last link."""

    id = "external_contact"
    title = "External contact"
    units = (("force", "N"), ("start", "s"), ("end", "s"))
    experiment = "the same motion again with nothing within reach"
    coordinate = "time"
    traits = SearchTraits(
        transient=True,
        discrete=tuple(
            f"{end}_{number}" for number in range(1, ADMISSIBLE.contacts + 1) for end in ("start", "end")
        ),
        trials=_spans_tried,
    )

    def sites(self, dataset: Dataset) -> Sequence[Site]:
        """List the joints of links that carry no other; several logs have no time in common."""
        return [(joint,) for joint in end_links(dataset.robot)] if len(dataset.motions) == 1 else []

    def grid(self, at: Setting) -> Sequence[Scalars]:
        """Find the spans in which the residual is a wrench on the link."""
        mask = fitted_rows(at.dataset)
        push = contact_jacobian(at.dataset.robot, end_links(at.dataset.robot)[at.joint], at.dataset.state)
        left = torque_residual(at.dataset, at.operating_point)
        found = find_events(
            at.dataset.time, push, left, inverse_covariances(at.dataset, left, mask), most=ADMISSIBLE.contacts
        )
        spans = sorted(span for span in found if not has_spike(at.dataset.motions[0].log, span))
        if not spans:
            return []
        return [
            {
                f"{name}_{number}": value
                for number, span in enumerate(spans, start=1)
                for name, value in zip(("start", "end"), span, strict=True)
            }
        ]

    def term(self, at: Setting) -> Term:
        """Give the columns."""
        return Contact(at.joint, end_links(at.dataset.robot)[at.joint], _spans(at.scalars))

    def admissible(self, solved: FittedCause) -> bool:
        """Admit a force that does not break the robot, and a moment that its lever explains."""
        wrenches = solved.values.reshape(-1, len(WRENCH))
        deviations = np.sqrt(np.maximum(np.diag(solved.covariance), 0.0)).reshape(-1, len(WRENCH))
        force = np.linalg.norm(wrenches[:, :3], axis=1)
        moment = np.linalg.norm(wrenches[:, 3:], axis=1)
        doubt = ADMISSIBLE.contact_deviations * np.linalg.norm(deviations, axis=1)
        return bool(
            np.all(force < ADMISSIBLE.contact_force)
            and np.all(moment < ADMISSIBLE.contact_lever * force + doubt)
        )

    def quantities(self, solved: FittedCause) -> tuple[Quantity, ...]:
        """Report every contact's peak force, its begin and end, and first the force with the least deviation.

        The largest force is often the least certain one: noise makes a force larger.
        """
        contacts = _contacts(solved)
        best = min(contacts, key=lambda contact: contact.doubt)
        found = [Quantity("force", solved.site[0], "N", best.force, best.deviation)]
        for number, contact in enumerate(contacts, start=1):
            # The edge of a half sine is as certain as its height, times a bit more than half its length.
            edge = EVENTS.edge * min(contact.doubt, 1.0) * (contact.span[1] - contact.span[0])
            found += [
                Quantity(f"force_{number}", solved.site[0], "N", contact.force, contact.deviation),
                Quantity(f"start_{number}", None, "s", contact.span[0], edge, is_instant=True),
                Quantity(f"end_{number}", None, "s", contact.span[1], edge, is_instant=True),
            ]
        return tuple(found)

    def statement(self, solved: FittedCause) -> str:
        """State spans and peak forces."""
        pushes = (
            f"{number_text(contact.force, 3)} ± {number_text(contact.deviation)} N from {begin:.3g} s to "
            f"{end:.3g} s"
            for contact in _contacts(solved)
            for begin, end in [contact.span]
        )
        return f"External contact on the link of joint {solved.site[0]}: {', '.join(pushes)}"


@dataclass(frozen=True)
class _Contact:
    """Hold one contact: its span, its peak force and that force's deviation, N."""

    span: Span
    force: float
    deviation: float

    @property
    def doubt(self) -> float:
        """Give the relative deviation of the force."""
        return self.deviation / max(self.force, 1e-12)


def _contacts(solved: FittedCause) -> list[_Contact]:
    forces = np.linalg.norm(solved.values.reshape(-1, len(WRENCH))[:, :3], axis=1)
    return [
        _Contact(span, float(forces[number]), _deviation(solved, number))
        for number, span in enumerate(_spans(solved.scalars))
    ]


def _deviation(solved: FittedCause, number: int) -> float:
    """Give the deviation of the norm of one contact's force, N, to first order: that along the force."""
    part = slice(len(WRENCH) * number, len(WRENCH) * number + 3)
    force = solved.values[part]
    along = force / max(float(np.linalg.norm(force)), 1e-300)
    return float(np.sqrt(max(along @ solved.covariance[part, part] @ along, 0.0)))
