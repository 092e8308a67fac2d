"""The claims of core.log, from formats to defects."""
