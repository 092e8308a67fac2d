"""Turn the measured into the usable: in comes a `JointLog` and a recipe, out goes a `Motion` on one clock."""
