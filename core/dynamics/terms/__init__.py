"""Hold one file per torque effect; each gives the columns that its parameters multiply."""
