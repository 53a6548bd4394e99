"""How networks learn: recipes, episodes side by side, imitation, trials and checkpoints."""
