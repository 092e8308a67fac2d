"""Mirror veritorque.core.audit."""
