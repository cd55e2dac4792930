"""What goes wrong."""


class ParseError(ValueError):
    """A file, or a scene, that cannot be used. Its text is one line: ``path:line: message``."""

    def __init__(self, text: str, path: str, message: str, line: int | None = None,
                 offset: int | None = None) -> None:
        super().__init__(text, path, message, line, offset)
        self.path = path
        """Which file."""
        self.message = message
        """What was expected there."""
        self.line = line
        """The line of a text file, from 1."""
        self.offset = offset
        """The byte of a binary file, from 0."""

    def __str__(self) -> str:
        return str(self.args[0])
