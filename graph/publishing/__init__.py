"""What Deck publishes: once, at a rate, or for as long as a hand holds it."""
