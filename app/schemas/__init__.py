"""Say what requests and responses look like: in comes JSON, out go strict models and documentation."""
