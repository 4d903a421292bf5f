"""A board's bitstream from pip-installed tools alone, or a project for its vendor's tool."""
