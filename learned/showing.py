"""What networks are shown: an image, and numbers beside it; each kind of world says how many."""

from fogbench.learned.policy import Policy


class Showing(Policy):
    """A policy whose network says by these how large its layers are; a subclass has them for its kind of world."""

    @property
    def plane(self) -> tuple[int, int]:
        """Rows and columns of the image."""
        raise NotImplementedError

    @property
    def seen_count(self) -> int:
        """Numbers of what is seen that a memory is told as they are, beside what is planned."""
        raise NotImplementedError

    @property
    def output_count(self) -> int:
        """Numbers that the network, or its memory, answers with."""
        raise NotImplementedError
