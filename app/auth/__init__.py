"""Find out who calls and how often: a request comes in, a tenant with scopes or a refusal goes out."""
