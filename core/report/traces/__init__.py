"""Keep what a study computed sample by sample: a model and its motions come in, traces to look at go out."""
