"""What the commands share: option types, folders of results, progress on the terminal, many scenes at once.

May import golden; nothing else of sim."""
