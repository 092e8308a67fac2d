"""Hold the commands of the command line: arguments come in, output and an exit code go out."""
