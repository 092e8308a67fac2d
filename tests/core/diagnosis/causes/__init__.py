"""What every suspected cause promises: where it looks, what nature allows, what it says."""
