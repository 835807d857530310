"""A building whose changes are known, and how well timemap's change events tell them."""
