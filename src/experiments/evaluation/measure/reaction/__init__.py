"""What comes of walks into obstacles, with a reaction and without."""
