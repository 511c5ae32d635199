"""`deck shell`: a shell in the domain of the lesson, and its words on what is not here."""
