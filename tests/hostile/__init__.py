"""Hold files that are made to hurt: a script makes each one, and none may do more than be refused."""
