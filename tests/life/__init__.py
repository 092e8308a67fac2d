"""Lead jobs through every turn that their life can take, and tenants past each other."""
