"""The panels of the Deck: each joins topics of the graph to a widget that draws them."""
