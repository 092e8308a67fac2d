"""Identify a YuMi arm from a log through the real HTTP service, then diagnose one that hides something.

What was found is printed beside the truth, and the report of the diagnosis is saved as one HTML file.

Run ``python -m examples.yumi.demo``; ``--log`` and ``--robot`` take one's own files, ``--url`` a service that
runs already.
"""

import argparse
import json
import os
import signal
import sys
import time
from pathlib import Path
from typing import Final, NoReturn

from rich.console import Console
from rich.markup import escape

from examples.yumi.diagnosis import print_diagnosis
from examples.yumi.service import ROOT, running_service
from examples.yumi.summary import Truth, print_summary
from veritorque.app.client.client import Client
from veritorque.app.client.progress import bar
from veritorque.app.client.records import Job
from veritorque.app.terminal.output.findings import Document
from veritorque.core.errors import VeritorqueError

HERE: Final = Path(__file__).parent
LOG: Final = HERE / "log.csv"
HIDDEN_LOG: Final = HERE / "hidden_log.csv"
BUILT_IN: Final = "yumi-left"


def read_truth(arguments: argparse.Namespace) -> Truth | None:
    """Give the true standard parameters where the log is the one whose truth is known."""
    if arguments.log != LOG or arguments.robot is not None:
        return None
    truth: Truth = json.loads((HERE / "truth.json").read_text(encoding="utf-8"))["standard_parameters"]
    return truth


def read_hidden(arguments: argparse.Namespace) -> list[Document] | None:
    """Give the hidden effects where the diagnosed log is the one that hides them."""
    if arguments.log != LOG or arguments.robot is not None:
        return None
    effects: list[Document] = json.loads((HERE / "hidden_truth.json").read_text(encoding="utf-8"))["hidden"]
    return effects


def compute(client: Client, kind: str, log: Path, robot: str, console: Console) -> tuple[Document, Job]:
    """Upload, ask, follow, fetch; give the result document and the job."""
    seen = client.upload(log)
    console.print(
        f"{escape(log.name)}: {seen.samples} samples, {seen.duration_s:.1f} s at {seen.rate_hz:.0f} Hz, "
        f"{seen.joints} joints, {len(seen.defects)} defects listed"
    )
    job = client.submit(kind, robot, seen)
    if job.finished:
        console.print("The service has computed this before and answers with the same job.")
    with bar(console) as tell:
        return client.wait(job, tell).document, job


def demonstrate(arguments: argparse.Namespace, console: Console) -> None:
    """Run the whole story once and print it."""
    if arguments.url is None:
        console.print("starting the service on loopback; the very first start compiles for about 20 s")
    service = Client(arguments.url) if arguments.url else running_service(arguments.data_dir)
    with service as client:
        console.print(f"service: {client.url}")
        robot = client.add_robot(arguments.robot).id if arguments.robot else BUILT_IN
        show_identification(client, arguments, robot, console)
        show_diagnosis(client, arguments, robot, console)


def show_identification(client: Client, arguments: argparse.Namespace, robot: str, console: Console) -> None:
    """Identify the robot and print its parameters."""
    console.rule("Identify")
    begin = time.monotonic()
    result, _ = compute(client, "identify", arguments.log, robot, console)
    seconds = time.monotonic() - begin
    print_summary(console, result, read_truth(arguments))
    console.print(f"Time from upload to result: {seconds:.1f} s.")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        console.print(f"result document: {escape(str(arguments.json))}")


def show_diagnosis(client: Client, arguments: argparse.Namespace, robot: str, console: Console) -> None:
    """Diagnose a log, print what the simulation gets wrong, and save the report."""
    console.rule("Diagnose")
    hidden = read_hidden(arguments)
    if hidden is not None:
        console.print("Now a log of an arm that does more than its description says.")
    log = arguments.log if hidden is None else HIDDEN_LOG
    begin = time.monotonic()
    result, job = compute(client, "diagnose", log, robot, console)
    seconds = time.monotonic() - begin
    print_diagnosis(console, result, hidden)
    console.print(f"Time from upload to diagnosis: {seconds:.1f} s.")
    target = arguments.report or arguments.data_dir / "diagnosis.html"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(client.report(job))
    console.print(f"[bold]Open the report in a browser: {escape(os.path.relpath(target))}[/]")


def print_problem(console: Console, error: VeritorqueError) -> None:
    """Say what is wrong, what was seen and what to do about it."""
    console.print(f"[red]{escape(error.cause)}[/]")
    for name, value in error.evidence.items():
        console.print(f"  {escape(name)}: {escape(str(value))}")
    if error.remedy:
        console.print(f"remedy: {escape(error.remedy)}")


def parse(words: list[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="demo", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--url", help="use the service that runs at this address")
    parser.add_argument("--log", type=Path, default=LOG, help="log to identify from and to diagnose")
    parser.add_argument("--robot", type=Path, help="description (JSON) or URDF of one's own robot")
    parser.add_argument("--json", type=Path, help="save the result document of the identification here")
    parser.add_argument("--report", type=Path, help="save the report of the diagnosis here")
    parser.add_argument(
        "--data-dir", type=Path, default=ROOT / "data" / "demo", help="where the service keeps its data"
    )
    return parser.parse_args(words)


def _interrupt(*_: object) -> NoReturn:
    raise KeyboardInterrupt


def main(words: list[str] | None = None) -> int:
    """Run the demonstration; give the exit status."""
    console = Console()
    try:
        demonstrate(parse(words), console)
    except VeritorqueError as error:
        print_problem(console, error)
        return 1
    except KeyboardInterrupt:
        console.print("stopped")
        return 130
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _interrupt)
    sys.exit(main())
