"""General graphs: nodes, of which each may be the next action, and edges that are seen from their ends."""
