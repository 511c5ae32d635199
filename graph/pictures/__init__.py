"""Camera messages as pictures for the screen: decoded, coloured, thinned out; never trusted."""
