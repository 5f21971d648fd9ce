"""What is made of tables and figures: the paper, its numbers, pages, the snapshot."""
