"""Maps of cells: what is passable, what is in view, how far it is, and where maps come from."""
