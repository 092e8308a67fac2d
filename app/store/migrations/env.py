"""Let Alembic run the steps on the connection and for the tables that it is given, in an open transaction."""

from alembic import context

given = (
    context.config.attributes
)  # Alembic runs this file by its path, so that it cannot import from beside it
context.configure(connection=given["connection"], target_metadata=given["metadata"])
context.run_migrations()
