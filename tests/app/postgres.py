"""Start a PostgreSQL of our own in a temporary folder, where the machine has one; it listens on no port."""

import contextlib
import getpass
import os
import secrets
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from sqlalchemy import URL, create_engine, text

USER = "veritorque"
SETTINGS = "-c listen_addresses= -c fsync=off -c max_connections=60"


def binaries() -> Path | None:
    """Find where PostgreSQL's programs are."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb")) or [
        Path(one) for one in [shutil.which("initdb")] if one
    ]
    return found[-1].parent if found else None


@contextlib.contextmanager
def cluster():
    """Run a server, and give the folder of its socket."""
    programs = binaries()
    if programs is None:
        pytest.skip("SKIPPED FOR WANT OF POSTGRESQL: initdb is not there (Debian: apt install postgresql)")
    folder = Path(tempfile.mkdtemp(prefix="vt-pg-"))
    run_as = ["runuser", "-u", "postgres", "--"] if getpass.getuser() == "root" else []
    if run_as:
        shutil.chown(folder, "postgres")
    start = f"{SETTINGS} -c unix_socket_directories={folder}"

    def run(*command):
        subprocess.run([*run_as, *command], check=True, capture_output=True, cwd="/", env=os.environ)

    run(str(programs / "initdb"), "-D", f"{folder}/data", "-U", USER, "-A", "trust", "--no-sync")
    run(str(programs / "pg_ctl"), "-D", f"{folder}/data", "-w", "-l", f"{folder}/log", "-o", start, "start")
    try:
        yield folder
    finally:
        run(str(programs / "pg_ctl"), "-D", f"{folder}/data", "-m", "immediate", "stop")
        shutil.rmtree(folder, ignore_errors=True)


def url(folder: Path, database: str) -> URL:
    """Name a database of the server."""
    return URL.create("postgresql+psycopg", username=USER, database=database, query={"host": str(folder)})


def new_database(folder: Path) -> str:
    """Make an empty database, and give its address."""
    name = "vt_" + secrets.token_hex(6)
    engine = create_engine(url(folder, "postgres"), isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE DATABASE {name}"))
    engine.dispose()
    return url(folder, name).render_as_string(hide_password=False)
