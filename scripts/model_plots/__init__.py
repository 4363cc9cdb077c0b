"""What scripts/model-plots draws, and how."""
