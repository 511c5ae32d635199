"""What the viewers beside the screen cost."""
