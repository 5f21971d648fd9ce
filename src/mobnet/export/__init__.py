"""What was learned here, for other programs: files that run on a robot without this project."""
