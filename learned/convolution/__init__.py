"""Four convolutions in a row: as PyTorch has them, and for batches on a CPU."""
