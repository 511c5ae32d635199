"""One module for each kind of mistake: what recognises it, and the sentence that it gets."""
