"""The generated tables and pictures of README.md and docs/. Only the command line (`hw.__main__`) and tests import
this room; it may import every other room of hw."""
