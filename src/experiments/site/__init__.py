"""What tells of the project itself: documents that are made, the published results, and the pages of all documents.

Nothing that an experiment runs imports it.
"""
