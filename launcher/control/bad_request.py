"""What is said to a client whose request cannot be served."""


class BadRequestError(Exception):
    """A client's request is invalid; the text says why."""
