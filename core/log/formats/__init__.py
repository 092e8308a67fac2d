"""Read the formats of log files: in come bytes, out goes a `Table` of named columns in batches of rows."""
