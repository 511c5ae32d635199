"""What every tab has around its body: title, recording, keys."""
