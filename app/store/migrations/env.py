"""Let Alembic run the steps on the connection it is given, within the transaction that is open there."""

from alembic import context

from ..tables import METADATA

context.configure(connection=context.config.attributes["connection"], target_metadata=METADATA)
context.run_migrations()
