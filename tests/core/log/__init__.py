"""The claims of veritorque.core.log, from formats to defects."""
