"""Hold every number that decides an answer of the diagnosis, once each, with its unit, meaning and source."""
