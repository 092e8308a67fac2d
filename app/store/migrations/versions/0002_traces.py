"""Let a job keep what it computed instant by instant."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Name the file of traces beside the result document; jobs of before have none."""
    op.add_column("jobs", sa.Column("traces_sha256", sa.String))
    op.create_index(op.f("ix_jobs_traces_sha256"), "jobs", ["traces_sha256"])
