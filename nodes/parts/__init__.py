"""What nodes are made of: their life, parameters, voice, and how they obey the emergency stop."""
