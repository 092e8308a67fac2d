"""Hold the residual atlas, the noise floor and the generic learner to what was put into a residual."""
