"""Keep what the product answers, or compare what it answers now with what was kept, on two processes.

Run ``make answers DO=record`` before a change and ``make answers DO=compare`` after it.
"""

import argparse
import os
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from fnmatch import fnmatch
from multiprocessing import get_context
from pathlib import Path

from tests.answers.compare import Compared, Difference, compare
from tests.answers.kept import keep, kept, names
from tests.answers.work import QUICK, Answer, answered, asks
from tests.saying import say

FOLDER = Path(__file__).parents[2] / ".answers"
SHOWN = 8
"""How many differences of one answer are printed."""


def main() -> int:
    """Do what is asked for; 1 where an answer differs in more than its wording."""
    asked = _arguments()
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"  # read by the processes that answer: sums in another order are other sums
    listed = [name for name in QUICK if name in asks()] if asked.quick else list(asks())
    listed = [name for name in listed if fnmatch(name, asked.only)]
    whole = not asked.quick and asked.only == "*"
    return (
        _record(asked.kept, listed) if asked.task == "record" else _compare(asked.kept, listed, whole=whole)
    )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("task", choices=("record", "compare"))
    parser.add_argument("--kept", type=Path, default=FOLDER, help="folder of the kept answers")
    parser.add_argument("--only", default="*", help="names of answers, as a shell pattern")
    parser.add_argument("--quick", action="store_true", help="a few telling answers that come fast")
    return parser.parse_args()


def _answers(listed: list[str]) -> Iterator[Answer]:
    """Give answers as they come; say at once which have no data."""
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        for done in as_completed([pool.submit(answered, name) for name in listed]):
            answer = done.result()
            if answer.document is None:
                say(f"{answer.name}: SKIPPED, {answer.missing}")
            yield answer


def _record(folder: Path, listed: list[str]) -> int:
    begun, seconds, count = time.monotonic(), 0.0, 0
    for answer in _answers(listed):
        seconds += answer.seconds
        if answer.document is not None:
            keep(folder, answer.name, answer.document)
            count += 1
            say(f"{answer.name}: kept{_refused(answer)} ({answer.seconds:.1f} s)")
    left = len(listed) - count
    say(
        f"{count} answers kept in {folder}, {left} skipped; "
        f"{seconds:.0f} s of processors, {time.monotonic() - begun:.0f} s"
    )
    return 0


def _refused(answer: Answer) -> str:
    return f", {answer.document['error']}" if answer.document and "error" in answer.document else ""


def _compare(folder: Path, listed: list[str], *, whole: bool) -> int:
    begun, seconds, found, skipped = time.monotonic(), 0.0, {}, 0
    gone = sorted(set(names(folder)) - set(asks())) if whole else []
    unkept = []
    for answer in _answers(listed):
        seconds += answer.seconds
        before = kept(folder, answer.name)
        if answer.document is None:
            skipped += 1
        elif before is None:
            unkept.append(answer.name)
            say(f"{answer.name}: NEVER KEPT ({answer.seconds:.1f} s)")
        else:
            found[answer.name] = compare(before, answer.document)
            _tell(answer, found[answer.name])
    for name in gone:
        say(f"{name}: kept, and asked no more")
    _tell_texts(found)
    failures = sum(len(one.failures) for one in found.values())
    texts = sum(len(one.texts) for one in found.values())
    good = not (failures or gone or unkept) and bool(found)
    differing = sum(bool(one.failures) for one in found.values())
    say(
        f"{len(found)} answers, {sum(one.numbers for one in found.values())} numbers and "
        f"{sum(one.strings for one in found.values())} strings compared: "
        + ("all equal" if good else f"{failures} differences in {differing} answers")
        + (f", {len(unkept)} never kept, {len(gone)} asked no more" if unkept or gone else "")
        + f", {texts} texts reworded, {skipped} skipped; {seconds:.0f} s of processors, "
        f"{time.monotonic() - begun:.0f} s"
    )
    return 0 if good else 1


def _tell(answer: Answer, found: Compared) -> None:
    """Print one line for an answer, and its differences below."""
    texts = f", {len(found.texts)} texts reworded" if found.texts else ""
    verdict = f"{len(found.failures)} DIFFERENCES" if found.failures else "equal"
    say(f"{answer.name}: {verdict}{texts} ({answer.seconds:.1f} s)")
    for one in found.failures[:SHOWN]:
        say(f"    {_shown(one)}")
    if len(found.failures) > SHOWN:
        say(f"    and {len(found.failures) - SHOWN} more")
    sized = [one for one in found.failures if one.ulps]
    if sized:
        worst = max(sized, key=lambda one: one.relative)
        say(f"    largest of numbers: {worst.relative:.1e} relative, {worst.ulps:.0f} ulps at {worst.path}")


def _shown(one: Difference) -> str:
    before, now = (repr(value)[:90] for value in (one.before, one.now))
    return f"{one.what} {one.path}: " + {"missing": before, "extra": now}.get(one.what, f"{before} -> {now}")


def _tell_texts(found: dict[str, Compared]) -> None:
    """Print where wording differs, by the place in the document, with one example each."""
    texts = [one for compared in found.values() for one in compared.texts]
    examples = {one.group: one for one in reversed(texts)}
    for group, count in Counter(one.group for one in texts).most_common():
        say(f"text {group}: {count} reworded\n    - {examples[group].before}\n    + {examples[group].now}")


if __name__ == "__main__":
    sys.exit(main())
