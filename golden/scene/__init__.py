"""Scene files: their keys, how they become a `golden.physics.scene.Scene`, and archives of scenes.

May import golden's other rooms but commands; golden.commands, hw and sim may import it."""
