"""Start the command line: ``python -m veritorque serve``.

The import stands inside, because every process that computes a job loads this module again under another
name.
"""

if __name__ == "__main__":
    from veritorque.app.terminal.start import main

    main()
