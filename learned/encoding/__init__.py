"""What a network sees of what an agent knows, and what its outputs mean, by the kind of world."""
