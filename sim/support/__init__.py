"""Shared by the commands: option types, folders of results, progress on the terminal, many scenes at once.

May import golden; nothing else of sim."""
