"""What the nodes share that ask a model: senses for it, its thread, and what it costs."""
