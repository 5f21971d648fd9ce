"""What is measured on recordings, estimates and trainings."""
