"""Pictures: what messages hold, what is shown of them, and where they are taken from."""
