"""The Sonar panel: the distance to the nearest obstacle."""
