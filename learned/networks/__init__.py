"""Networks, one file each; their settings, which are read without PyTorch, are in the files above of the same names."""
