"""Hold what routes need: a request's data come in, records, responses and readings of the service go out."""
