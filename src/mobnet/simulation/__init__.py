"""The plant: terrain, friction, noise, disturbances, and the loop that turns a scenario into a Recording."""
