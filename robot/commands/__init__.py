"""What may be asked of the robot in words or JSON: the schema, and what is wrong with a text."""
