"""Map files of other projects, read into cells."""
