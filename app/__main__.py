"""Start the command line: ``python -m app serve``.

The import stands inside, because every process that computes a job loads this module again under another
name.
"""

if __name__ == "__main__":
    from app.terminal.start import main

    main()
