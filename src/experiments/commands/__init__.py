"""What `./reproduce` does before packages are installed: its words, the environment, and what it removes.

Standard library only.
"""
