"""A simulated building, robot and laser, and the small recordings made with them."""
