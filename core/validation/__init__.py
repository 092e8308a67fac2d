"""Ask whether it predicts the unseen: in comes an estimate and held-out equations, out come scores and certificates."""
